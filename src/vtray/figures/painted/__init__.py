"""Annotations painted onto the pixels of a picture: a file for each kind, by Pillow's letters."""
