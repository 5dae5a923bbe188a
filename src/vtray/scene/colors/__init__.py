"""Colours: names, maps, and arrays of them."""
