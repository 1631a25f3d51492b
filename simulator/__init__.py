"""SAPIEN simulator: world files, rendering, robot physics, sensors and the bus loop around them."""
