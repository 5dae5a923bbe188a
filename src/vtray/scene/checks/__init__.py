"""What a scene may hold, and the words for what it may not."""
