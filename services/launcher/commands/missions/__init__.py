"""Commands that send a robot somewhere, at once or when its turn comes."""
