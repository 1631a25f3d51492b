"""Plans and pictures of runs."""
