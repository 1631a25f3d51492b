"""Where in a map an ordinary photo was taken, and which way it looks."""
