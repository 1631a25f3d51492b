"""Drive service: from a heading and 12 distances to wheel commands."""
