"""The thesis's Monte Carlo simulations of the heading methods (section 3.2), and what they left out.

Scenes are points in space without pictures. Every figure that the thesis does not state (Q27) is a
constant of `scene.py` and `tracking.py`.
"""
