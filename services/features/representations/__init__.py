"""Ways to cut a sphere into pictures, one plugin per file, file name = plugin name."""
