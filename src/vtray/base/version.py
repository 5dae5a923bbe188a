"""The version of vtray."""

__version__ = "0.2.0.dev0"
SOFTWARE = f"vtray {__version__}"
"""How files name the program that wrote them."""
