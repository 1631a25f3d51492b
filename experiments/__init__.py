"""Studies of the heading methods, the matching and the whole loop."""
