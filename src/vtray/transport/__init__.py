"""What light does: from a tile of pixels to what is seen there."""
