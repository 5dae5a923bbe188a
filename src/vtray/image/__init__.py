"""What comes out: a picture, its exposure, and how it was made."""
