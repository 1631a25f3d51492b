"""Which nodes of a large map may be the one that is seen, before any of them is looked at closely."""
