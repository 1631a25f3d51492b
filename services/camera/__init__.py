"""Camera service: one 360-degree camera, found by URL, to frames on the bus."""
