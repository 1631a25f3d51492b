"""The Python library of the thesis (appendix A) as a thin layer over this project's pure code.

    from experiments.topological_navigation import TopologicalNavigation

is the one line by which appendix B's program differs. Everything happens in this process: no bus, no
services. Pictures are whole panoramas, columns and longitudes as in shared.geometry; headings are degrees,
0 ahead, counter-clockwise positive.
"""

from experiments.topological_navigation.keypoints import SelectKeypointDescriptor
from experiments.topological_navigation.navigation import TopologicalNavigation

__all__ = ["SelectKeypointDescriptor", "TopologicalNavigation"]
