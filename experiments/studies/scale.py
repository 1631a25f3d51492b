"""`topnav study scale`: cost and recall as a map grows from 100 to 100,000 places; load as robots do."""

import tempfile
from pathlib import Path
from typing import Annotated, Any

import typer

from experiments.bench.machine import machine
from experiments.plots.scale import draw_growth
from experiments.scale.frames import frames_of
from experiments.scale.packing_loss import packing_losses
from experiments.scale.robots import Load, Work, measure_loads
from experiments.scale.study import ScaleStudy
from services.features.pipeline.named_pipelines import find_profile
from services.features.pipeline.pipeline import Pipeline
from services.launcher.client.failure import one_line_errors
from services.launcher.terminal import options
from services.launcher.terminal.output import write_json
from services.launcher.terminal.tables import print_rows, wide_console
from simulator.world.world_file import load_world

MAPPED = {"apartment": 100, "factory": 200, "village": 200}
FOREIGN = {"break_room": 100}
"""Worlds in the maps and outside of them, with how many pictures are taken there."""
SIZES, QUICK_SIZES = (100, 1000, 10_000, 100_000), (100, 300)
PEER_PLACES, PEER_PICTURES = 1000, 40
PACKED_WORLD, PACKED_PICTURES, QUICK_PACKED_PICTURES = "apartment", 20, 2
FLEETS, QUICK_FLEETS = (1, 2, 4, 8, 16), (1, 2)
SERVICES, RATES_HZ = (1, 2), (0.0, 2.0)
"""Feature services that share the robots; frames a second of each robot, 0: as fast as they are answered."""
LOAD_S, QUICK_LOAD_S = 15.0, 3.0


def main(
    quick: Annotated[bool, typer.Option("--quick", help="Maps of 100 and 300 places.")] = False,
    sizes: Annotated[str | None, typer.Option(help='Places of the maps, as "100,1000".')] = None,
    robots: Annotated[str | None, typer.Option(help='Robots that ask at once, as "1,4".')] = None,
    plot: Annotated[Path | None, typer.Option(help="Draw the growth into this PNG.")] = None,
    seed: options.Seed = 1,
    pipeline: options.PipelineName = None,
    json_file: options.JsonFile = None,
    data_dir: options.DataDir = options.DATA_DIR,
) -> int:
    """Growth of the time to find a place, of memory and of loading; others on the same pictures; robots."""
    counts = [int(size) for size in sizes.split(",")] if sizes else list(QUICK_SIZES if quick else SIZES)
    fleets = [int(size) for size in robots.split(",")] if robots else list(QUICK_FLEETS if quick else FLEETS)
    chosen = Pipeline(find_profile(pipeline or "sift"))
    report: dict[str, Any] = {"machine": machine(), "seed": seed, "points": [], "peers": [], "refusal": {}}
    report["robots"] = []

    def keep() -> None:
        if json_file is not None:
            write_json(json_file, report)

    with wide_console(stderr=True).status("") as status:
        cache = data_dir / "cache"
        frames = [frames_of(world, chosen, n, seed, cache, status.update) for world, n in MAPPED.items()]
        foreign = [frames_of(world, chosen, n, seed, cache, status.update) for world, n in FOREIGN.items()]
        study = ScaleStudy(chosen, frames, [seen for each in foreign for seen in each.queries], seed)
        for count in counts:
            status.update(f"a map of {count} places")
            row, places = study.point(count)
            report["points"].append(row)
            if count == max(counts):
                status.update(f"pictures that are not in the map of {count} places")
                report["refusal"] = study.refusal(places, count)
            keep()
        status.update("others on the same pictures")
        report["peers"] = study.peers(min(PEER_PLACES, max(counts)), PEER_PICTURES)
        keep()
        pictures = QUICK_PACKED_PICTURES if quick else PACKED_PICTURES
        report["packing"] = list(packing_losses(load_world(PACKED_WORLD), pictures, seed, status.update))
        keep()
        loads = [Load(n, k, rate) for rate in RATES_HZ for k in SERVICES for n in fleets if n >= k]
        with tempfile.TemporaryDirectory(prefix="topnav-scale-") as folder, one_line_errors():
            work = Work(frames[0], pipeline or "sift", Path(folder), QUICK_LOAD_S if quick else LOAD_S)
            for row in measure_loads(loads, work, status.update):
                report["robots"].append(row)
                keep()
    if plot is not None:
        draw_growth(plot, report["points"], report["robots"])
    print_rows("maps that grow", report["points"])
    print_rows("on the same pictures", report["peers"])
    print_rows("matches lost by packing", report["packing"])
    print_rows("not in this map", [{k: v for k, v in report["refusal"].items() if k != "curve"}])
    print_rows("robots that ask at once", report["robots"])
    return len(report["points"])
