"""The simulated robot as one in ROS 2: what it senses goes out over a wire of ROS, velocities come in."""
