"""What Python is told where code may give no warning: all but what other packages do."""

STRICT = ("-W", "error", "-W", "ignore:Setting the shape:DeprecationWarning")
"""ASE sets the shapes of arrays, of which NumPy 2.5 warns."""
