"""Furniture: one kind a file, each a function from options and a seed to a Piece in its own frame (front along +x)."""
