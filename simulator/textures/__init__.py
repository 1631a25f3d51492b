"""Procedural textures: every picture a world shows is drawn from a kind, a colour and a seed."""
