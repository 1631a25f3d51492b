"""Where nodes lie relative to one of them, by bearings and driven lengths; never a global position."""
