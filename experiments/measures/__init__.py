"""Figures computed from true poses. Pure."""
