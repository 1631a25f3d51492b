"""`topnav study cycles`: by how much the triangles of a map do not close."""

from itertools import permutations

import typer

from experiments.work.record import on_record
from services.launcher.terminal import options

app = typer.Typer()

PERCENTILES = (50.0, 99.0, 99.9, 100.0)


@app.command("cycles")
@on_record("study cycles")
def cycles(
    map_name: options.MapName = "flat",
    json_file: options.JsonFile = None,
    data_dir: options.DataDir = options.DATA_DIR,
) -> int:
    """What yaws and bearings round all triangles of a map miss: the tolerances of cycle consistency."""
    import numpy as np

    from services.launcher.client.failure import ExperimentError
    from services.launcher.client.maps import open_store
    from services.launcher.terminal.output import print_rows, write_json
    from shared.mapgraph.graph import MapGraph
    from shared.mapgraph.triangle import triangle_misses
    from shared.messages.maps import Edge

    with open_store(data_dir) as store:
        rows = store.get(f"/maps/{map_name}/edges").raise_for_status().json()
    graph = MapGraph(edges=[Edge.model_validate(row) for row in rows])
    found = {
        frozenset((a, b, c)) for a, b in graph.edges for c in {*graph.neighbours(a)} & {*graph.neighbours(b)}
    }
    misses = [
        miss
        for corners in found
        for frame, node, other in permutations(corners)
        if (to_node := graph.sight(frame, node)) is not None
        and (to_other := graph.sight(frame, other)) is not None
        and (onward := graph.sight(node, other)) is not None
        and (miss := triangle_misses(to_node, to_other, onward)) is not None
    ]
    if not misses:
        raise ExperimentError(f"map {map_name!r} has no triangle of edges with known yaws")
    measured = {
        "yaw": [miss.yaw_rad for miss in misses],
        "direction": [miss.direction_rad for miss in misses if miss.direction_rad is not None],
    }
    table = [
        {"miss": name} | {f"p{p:g}_deg": float(np.degrees(np.percentile(values, p))) for p in PERCENTILES}
        for name, values in measured.items()
        if values
    ]
    write_json(json_file, {"map": map_name, "triangles": len(found), "misses": table})
    print_rows(f"{len(found)} triangles of {map_name}", table)
    return len(found)
