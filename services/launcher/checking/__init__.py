"""`topnav robot check`: whether a robot is what topnav takes it for."""
