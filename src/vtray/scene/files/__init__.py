"""Scene files: read, written, and their schema."""
