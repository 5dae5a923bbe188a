"""The fast path for rays that run near each other."""
