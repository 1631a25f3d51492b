"""Pictures of places and what changed in them: kept by visit, told as rounds."""
