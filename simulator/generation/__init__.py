"""Worlds nobody drew: a plan, rooms furnished for what they are used for, checked before they are written."""
