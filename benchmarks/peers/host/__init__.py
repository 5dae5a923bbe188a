"""How scenes reach programs of ours that render with the library of another renderer."""
