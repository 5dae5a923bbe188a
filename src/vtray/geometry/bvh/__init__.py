"""The bounding volume hierarchy: how it is built, and what it is made of."""
