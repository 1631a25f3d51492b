"""Sign service: text that the robot passes while it maps, kept with bearing and node."""
