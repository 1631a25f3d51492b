"""The study over worlds: side by side, kept when done, so that it goes on where it was cut off."""

from collections.abc import Sequence
from concurrent.futures import as_completed
from pathlib import Path
from typing import Any

from rich.progress import Progress

from experiments.training.keypoints.measure import WorldPart, measure_world, profile_of
from experiments.training.keypoints.tables import answer_table, recurrence_table
from experiments.training.worlds import first_worlds
from experiments.work.results_file import ResultsFile
from experiments.work.workers import workers
from services.launcher.client.failure import ExperimentError
from services.launcher.terminal.output import wide_console


def run(
    worlds: int,
    pairs: int,
    detectors: tuple[str, ...],
    sizes: Sequence[str],
    width_px: int,
    seed: int,
    jobs: int,
    json_file: Path | None,
) -> list[dict[str, Any]]:
    """Measure what `json_file` lacks and write the tables into it.

    Returns:
        A row for each pair and detector.

    Raises:
        ExperimentError: no such detector or size, or a file of another setup.
    """
    try:
        for name in detectors:
            profile_of(name)
        chosen = first_worlds("validation", worlds, sizes=sizes)
    except ValueError as error:
        raise ExperimentError(str(error)) from error
    setup = {
        "pairs": pairs,
        "detectors": list(detectors),
        "width_px": width_px,
        "seed": seed,
        "split": "validation",
    }
    file = ResultsFile(json_file, setup, main="pairs_measured")
    done = {row["world"] for row in file.results}
    parts = [WorldPart(world, pairs, detectors, width_px, seed) for world in chosen if str(world) not in done]
    with workers(jobs, None) as pool, Progress(console=wide_console(stderr=True), transient=True) as progress:
        task = progress.add_task("worlds", total=len(parts))
        for future in as_completed([pool.submit(measure_world, part) for part in parts]):
            file.add(*future.result())
            progress.advance(task)
    names = {str(world) for world in chosen}
    rows = [row for row in file.results if row["world"] in names]
    file.write(keypoints=recurrence_table(rows, detectors), answers=answer_table(rows))
    return rows
