"""Tone maps: curves from the light of a scene to that of a monitor."""
