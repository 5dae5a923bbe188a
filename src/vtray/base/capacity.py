"""How much vtray can hold."""

MAX_SPHERES = 2**27
"""Spheres of a scene: as many as a leaf of the hierarchy can name."""

MAX_NUMBERS = 2**31 - 1
"""Primitives of a scene, each copy counted: as many as 32 bits can number."""
