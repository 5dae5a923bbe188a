"""Embree."""
