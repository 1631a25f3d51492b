"""The program of the thesis's appendix B; only the import line differs. Usage: MAP TARGET CURRENT."""

import sys

from experiments.topological_navigation import TopologicalNavigation

map_file, target, current = sys.argv[1:4]
tp = TopologicalNavigation(
    device="cuda", crop_degree=25, max_keypoints=150, min_matches=40, resize=[400, 800], mapping_stage=False
)
tp.load_map(map_name=map_file)
tp.draw_map()
tp.target_frame = target
tp.current_frame = current
tp.compare_current_frame_with_map()
tp.draw_path().savefig("path.png")
print(f"heading {tp.heading:.1f} deg")
