"""Figures, comparisons, and rays drawn and told."""
