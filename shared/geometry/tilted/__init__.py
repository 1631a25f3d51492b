"""Relative pose of cameras that lean: any rotation and travel, weighed by what matches tell of themselves."""
