"""Routes: taught by driving, kept in the map by name, driven node by node."""
