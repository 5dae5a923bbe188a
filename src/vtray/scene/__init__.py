"""What people describe."""
