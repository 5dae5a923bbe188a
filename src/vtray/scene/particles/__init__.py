"""Particles: what simulations and instruments give, and how it becomes objects of a scene."""
