"""Colours as people write them: names, hex digits, integers from 0 to 255, floats from 0 to 1.

They become the format's integers from 0 to 255 without any other change. A float is rounded to the
nearest of these, the middle between two up: 0.5 becomes 128.
"""

from vtray.scene.colors.names import to_rgb

__all__ = ["to_rgb"]
