"""Drive service: from a heading and 12 distances to the velocity of the robot."""
