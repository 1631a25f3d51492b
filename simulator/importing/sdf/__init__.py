"""Reading of SDF worlds."""
