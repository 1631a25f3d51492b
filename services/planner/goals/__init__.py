"""Where a goal is: the nodes and places it resembles, and what the way there teaches of it."""
