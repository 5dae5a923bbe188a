"""Cycles, Blender's path tracer."""
