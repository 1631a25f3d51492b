"""The one mission of a robot: begun, steered, ended, kept by the map store and told to everyone."""
