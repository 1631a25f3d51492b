"""Feature service: features of every frame, and how frames relate to nodes of the map."""
