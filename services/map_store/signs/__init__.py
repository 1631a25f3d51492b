"""Signs that were read in a map, over REST."""
