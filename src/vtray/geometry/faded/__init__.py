"""Shapes that light passes in part."""
