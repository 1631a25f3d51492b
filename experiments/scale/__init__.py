"""`topnav study scale`: what maps of 100 to 100,000 places cost, and how they are searched."""
