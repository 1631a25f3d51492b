"""A map from a sequence of panoramas, without a robot. Usage: MAP.zip PICTURE PICTURE ..."""

import sys

from experiments.topological_navigation import TopologicalNavigation

map_file, *pictures = sys.argv[1:]
tp = TopologicalNavigation("cpu", 25, 150, 40, [400, 800], mapping_stage=True)
for picture in pictures:
    tp.current_frame = picture
    print(picture, tp.compare_current_frame_with_map().why)
print(f"{len(tp.topo_map.graph.nodes)} nodes, {len(tp.topo_map.graph.edges)} edges")
tp.save_map(map_file)
tp.draw_map().savefig("map.png")
