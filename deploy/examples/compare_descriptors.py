"""Keypoints that two panoramas share, by descriptor and representation. Usage: PICTURE PICTURE."""

import sys

from experiments.topological_navigation import SelectKeypointDescriptor

for name in ("SIFT", "ORB", "BEBLID"):
    for representation in ("Cartesian", "Equirectangular", "Tangent"):
        tool = SelectKeypointDescriptor(sys.argv[1], name, representation=representation, max_keypoints=300)
        tool.matcher_selection = "NearestNeighbor"
        tool.update_kp_changes()
        first, second = (tool.features(tool.read(path)) for path in sys.argv[1:3])
        (pairs,) = tool.pipeline.matcher.match(first, [second])
        print(f"{name:7} {representation:16} {len(first)} keypoints, {len(pairs)} matches")
