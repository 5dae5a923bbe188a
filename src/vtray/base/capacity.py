"""How much vtray can hold."""

MAX_SPHERES = 2**27
"""Spheres of a scene: as many as a leaf of the hierarchy can name."""
