"""An ordinary photo against panoramas: its camera, what matches say of its pose, and the pose. Pure."""
