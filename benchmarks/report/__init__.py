"""The results as tables and a picture."""
