"""OVITO."""
