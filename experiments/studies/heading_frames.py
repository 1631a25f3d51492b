"""`topnav study heading-frames`: heading errors of all seven methods on rendered frame pairs."""

from pathlib import Path
from typing import Annotated

import numpy as np
import typer
from rich.progress import track

from experiments.studies.pair_features import features_of_pairs
from experiments.studies.pair_headings import PairResult, judge_pair
from experiments.studies.pair_tables import distance_table, method_table, status_counts
from experiments.studies.pairs import APART_M, draw_pairs
from experiments.studies.rendered_views import cache_folder
from services.features.pipeline.named_pipelines import find_profile
from services.features.pipeline.pipeline import Pipeline
from services.launcher.terminal import options
from services.launcher.terminal.output import write_json
from services.launcher.terminal.tables import print_rows, wide_console
from simulator.world.freespace import free_space
from simulator.world.world_file import load_world

Pairs = Annotated[int, typer.Option(min=1, help="How many pairs of frames.")]
Quick = Annotated[bool, typer.Option("--quick", help="60 pairs only.")]
QUICK_PAIRS = 60


def main(
    world: options.World = "apartment",
    pairs: Pairs = 500,
    quick: Quick = False,
    seed: options.Seed = 1,
    pipeline: options.PipelineName = None,
    json_file: options.JsonFile = None,
    data_dir: options.DataDir = options.DATA_DIR,
) -> int:
    """Heading errors of all seven methods from the same matches, frames 0.3 to 3 m apart."""
    results = measure(world, QUICK_PAIRS if quick else pairs, seed, pipeline or "sift", data_dir)
    verified, raw = method_table(results), method_table(results, raw=True)
    by_distance = distance_table(results)
    if json_file is not None:
        report = {
            "pairs": len(results),
            "methods": verified,
            "world": world,
            "seed": seed,
            "pipeline": pipeline or "sift",
            "methods_raw_matches": raw,
            "by_distance": by_distance,
            "two_view_status": status_counts(results),
        }
        write_json(json_file, report)
    for title, table in (("verified matches", verified), ("raw matches", raw)):
        print_rows(f"heading error, {title}", [{"method": name, **row} for name, row in table.items()])
    print_rows("by distance, epipolar", by_distance)
    return len(results)


def measure(
    world_name: str,
    count: int,
    seed: int,
    pipeline_name: str,
    data_dir: Path,
    apart_m: tuple[float, float] = APART_M,
) -> list[PairResult]:
    """Draw the pairs, render what is not kept yet, and judge every method."""
    world = load_world(world_name)
    pipeline = Pipeline(find_profile(pipeline_name))
    pairs = draw_pairs(free_space(world), count, np.random.default_rng(seed), apart_m)
    folder = cache_folder(data_dir / "cache", "pairs", world, pipeline, seed, apart_m)
    console = wide_console(stderr=True)
    with console.status("") as status:
        done = iter(range(1, count + 1))
        features = features_of_pairs(
            pairs, world, pipeline, folder, lambda: status.update(f"frames of pair {next(done)}/{count}")
        )
    numbers = track(range(count), "headings", console=console, transient=True)
    return [judge_pair(pairs[n], features[n], pipeline, n) for n in numbers]
