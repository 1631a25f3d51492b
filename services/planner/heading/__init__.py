"""Heading from matched bearings: the thesis's methods 1 to 6, the epipolar direction, the choice.

All functions are pure. Frames and angles as in shared.geometry: longitude 0 ahead, counter-clockwise
positive.
"""
