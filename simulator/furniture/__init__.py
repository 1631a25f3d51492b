"""Furniture: one kind a file, a function from options and a seed to a Piece whose front looks along +x."""
