"""How pictures look without any settings, beside those of OVITO."""
