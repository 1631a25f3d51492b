"""`topnav study scale`: what maps of 100 to 100,000 nodes cost, and how they are searched."""
