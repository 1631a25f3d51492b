"""Ways to pair descriptors, one plugin per file, file name = plugin name."""
