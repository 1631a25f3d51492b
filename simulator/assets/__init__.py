"""Files that users bring: models and pictures beside their world file."""
