"""POV-Ray."""
