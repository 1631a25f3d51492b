"""Missions to where ordinary photos were taken."""
