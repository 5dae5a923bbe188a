"""A picture step by step: scene, arrays, hierarchy, passes, image."""
