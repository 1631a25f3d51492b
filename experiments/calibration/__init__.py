"""Thresholds of similarity from pairs of pictures: rendered, of a tour of photographs, or of a recording."""
