"""Reading of meshes in other formats, and writing of our models."""
