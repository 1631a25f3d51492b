"""Worlds that others made: Gazebo's SDF and glTF scenes, turned into world files."""
