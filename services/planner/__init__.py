"""Planner service: missions, localisation, paths and headings. Sees pictures and distances, never poses."""
