"""Phone pictures of rendered worlds: where the core says they were taken, against the truth."""
