"""Training of our own features and matcher: exact pairs from rendered worlds, recipes, evaluation."""
