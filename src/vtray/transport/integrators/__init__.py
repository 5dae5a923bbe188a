"""How the light along a ray is found."""
