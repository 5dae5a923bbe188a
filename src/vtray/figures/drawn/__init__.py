"""Shapes as a drawing shows them: a file for each kind, and which objects are of which."""
