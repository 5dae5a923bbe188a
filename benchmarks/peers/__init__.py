"""The other renderers, beside which vtray is measured."""
