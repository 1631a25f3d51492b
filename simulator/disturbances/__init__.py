"""Seeded disturbances of the simulated world and camera. Each is a module with a level from 0 (off) to 1."""
