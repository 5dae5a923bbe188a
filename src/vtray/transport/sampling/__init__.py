"""Which rays are cast for which pixels, and what each counts."""
