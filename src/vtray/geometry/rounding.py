"""How far rounding can carry a computed point, and what follows from it.

A hit point ``eye + t * direction`` is the result of about twenty roundings, each of at most half a
machine epsilon of the magnitudes that take part. Instead of moving the start of a shadow ray off
its surface by some offset, vtray asks how far a point is from a surface: nearer than rounding could
have carried it means *on* the surface, which does not block a ray that starts on it, unless the ray
crosses it elsewhere. The same holds for a light, whose place was rounded where it was worked out,
in world space. The same bound decides whether a hit lies in front of the image plane, and whether a
light is above the horizon of the surface that it shines on.

References
----------
The running bound on n roundings is Higham's gamma_n: *Physically Based Rendering*, 4th edition,
section 6.8.
"""

ROUNDING = 2.0**-47
"""Bound on the distance of a computed point from its true surface, relative to the magnitudes that
took part: 32 machine epsilons, where the longest chain of operations can reach 20."""

MARGIN = 8.0 * ROUNDING
"""How much wider than that things are taken where it is asked whether they can be left out."""
