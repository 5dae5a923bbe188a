"""How much of a light arrives, as an estimate from the rays of some fans, and how wrong it may be.

Two rays that follow each other in a fan share a cell of the square from which they are drawn. With
a and b for what they bring, the mean of n rays has a variance of about the sum of (a - b)^2 over
all pairs, divided by n^2: that of samples drawn from n / 2 cells, two in each. As the points of a
fan are spread more evenly than that, this is too much rather than too little; so is the variance
from fan to fan, of which each is the next block of one sequence.

A thing so small that no ray meets it is not known of. It has no say in how many rays are cast, but
what it could stop counts as an error of half a ray.

A light whose colour changes with the direction has three shares, each of which has a total; of
their variances the largest counts. For other lights the second and the third are 0.

References
----------
Cochran, "Sampling Techniques", 3rd edition, 1977, section 5A.12 (collapsed strata, pairs).
"""

from typing import NamedTuple

from vtray.base.compiler.compiled import device
from vtray.geometry.packets.batch import ESTIMATE, Batch
from vtray.geometry.vector import Vec, add
from vtray.transport.sampling.fans import Fans

UNSEEN = 0.5
"""What no ray meets counts as an error of such a part of a ray."""


LEAST = 0.25
"""Each light may have such a part of an equal part of the variance, whatever others have had."""


AS_NEEDED = 0
"""In place of a number of fans: so many as their variance asks for."""


class Estimate(NamedTuple):
    """What is known after some fans.

    Attributes
    ----------
    fans
        How many there were.
    total, squares
        The sums of their shares, and of the squares of these, for each component of the light.
    spread
        The variance of the first one, from its pairs.
    """

    fans: int
    total: Vec
    squares: Vec
    spread: float


@device
def no_estimate() -> Estimate:
    """Return what is known before the first fan."""
    return Estimate(0, (0.0, 0.0, 0.0), (0.0, 0.0, 0.0), 0.0)


@device
def with_fan(estimate: Estimate, shares: Vec, spread: float) -> Estimate:
    """Return what is known after one more fan, given its `light_rays.arriving_shares`."""
    red, green, blue = shares
    return Estimate(
        estimate.fans + 1,
        add(estimate.total, shares),
        add(estimate.squares, (red * red, green * green, blue * blue)),
        estimate.spread if estimate.fans > 0 else spread,
    )


@device
def load_estimate(batch: Batch, member: int) -> Estimate:
    """Return the estimate at a hit of a batch."""
    kept, k = batch.estimate, ESTIMATE * member
    total, squares = (
        (kept[k + 1], kept[k + 2], kept[k + 3]),
        (kept[k + 4], kept[k + 5], kept[k + 6]),
    )
    return Estimate(int(kept[k]), total, squares, kept[k + 7])


@device
def store_estimate(batch: Batch, member: int, estimate: Estimate) -> None:
    """Set the estimate at a hit of a batch."""
    kept, k = batch.estimate, ESTIMATE * member
    kept[k] = estimate.fans
    kept[k + 1], kept[k + 2], kept[k + 3] = estimate.total
    kept[k + 4], kept[k + 5], kept[k + 6] = estimate.squares
    kept[k + 7] = estimate.spread


@device
def needs_more(
    estimate: Estimate, fans: Fans, count: int, worth: float, spent: float, light: int, lights: int
) -> bool:
    """Tell whether another fan is to be cast.

    Parameters
    ----------
    estimate, fans
        What is known so far, and which fans there are.
    count
        How many are to be cast, or ``AS_NEEDED``.
    worth
        The largest channel of what all of the light adds, shining squarely.
    spent
        What the lights before this one have of the variance that all may have, as
        `counted_variance` gives it; what they left is shared with the next.
    light, lights
        The number of this light among the soft ones, and how many there are.
    """
    if estimate.fans == 0:
        return True
    if count != AS_NEEDED:
        return estimate.fans < count
    allowed = max((1.0 - spent) / (lights - light), LEAST / lights)
    is_noisy = counted_variance(estimate, fans, worth) > allowed
    return is_noisy and estimate.fans < fans.fans


@device
def counted_variance(estimate: Estimate, fans: Fans, worth: float) -> float:
    """Return the variance of what a light adds, as a part of what all lights may have."""
    scale = (worth if fans.by_light else 1.0) / fans.error
    return scale * scale * variance_of(estimate)


@device
def shares_of(estimate: Estimate) -> Vec:
    """Return the shares of a light that arrive: the means of the fans, 0 if there is none."""
    fans = max(estimate.fans, 1)
    return estimate.total[0] / fans, estimate.total[1] / fans, estimate.total[2] / fans


@device
def variance_of(estimate: Estimate) -> float:
    """Return the variance of the noisiest share.

    What the pairs of the first fan say counts as much as one difference between fans.
    """
    fans = max(estimate.fans, 1)
    between = 0.0
    for component in range(3):
        total, squares = estimate.total[component], estimate.squares[component]
        between = max(between, squares - total * total / fans)
    return (estimate.spread + between) / (fans * fans)


@device
def with_unseen(estimate: Estimate, rays: int, weight: float) -> float:
    """Return the variance of the shares, at least what fans of so many rays may not see.

    The weight is what one of the rays counts.
    """
    unseen = UNSEEN * weight / (max(estimate.fans, 1) * rays)
    return max(variance_of(estimate), unseen * unseen)
