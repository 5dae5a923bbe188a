"""The version of vtray."""

__version__ = "0.1.0"
SOFTWARE = f"vtray {__version__}"
"""How files name the program that wrote them."""
