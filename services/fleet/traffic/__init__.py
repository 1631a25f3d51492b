"""Rights of way: robots that drive through one map ask for the nodes ahead before they go there."""
