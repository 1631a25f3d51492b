"""Feature service: visual words of every frame, and how frames relate to places of the map."""
