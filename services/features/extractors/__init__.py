"""Detectors and descriptors, one plugin per file, file name = plugin name."""
