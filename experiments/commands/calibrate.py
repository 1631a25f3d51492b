"""`topnav calibrate`: measure what a pipeline's similarity means, and propose the planner's thresholds."""

from pathlib import Path
from typing import Annotated, Any

import typer

from services.launcher.terminal import options

app = typer.Typer()

Tours = Annotated[Path | None, typer.Option(help="Measure on linked photographs instead: a folder of tours.")]
Recording = Annotated[
    Path | None, typer.Option(help="Measure on a recorded drive instead: a file of topnav record.")
]


@app.command()
def calibrate(
    world: options.World = "apartment",
    tours: Tours = None,
    recording: Recording = None,
    pipeline: Annotated[
        str | None, typer.Option(help="Feature pipeline to measure; default: the one that suits the world.")
    ] = None,
    base: Annotated[
        str | None,
        typer.Option(help="Profile with all other rules, for example thesis; default: photo or default."),
    ] = None,
    pairs: Annotated[int, typer.Option(min=20, help="How many pairs of frames.")] = 500,
    seed: options.Seed = 1,
    json_file: options.JsonFile = None,
    write: Annotated[
        Path | None, typer.Option(help="Write a profile with these thresholds, for --profile FILE.")
    ] = None,
    data_dir: options.DataDir = options.DATA_DIR,
) -> None:
    """Measure the thresholds of a pipeline: on rendered pairs of frames, a tour or a recording."""
    from experiments.calibration.measuring import of_rendering
    from experiments.calibration.recordings import pairs_of_recording
    from experiments.calibration.thresholds import distance_rows, propose, propose_by_count
    from experiments.calibration.tours import pairs_of_tours
    from experiments.photographs.tours import read_tours
    from experiments.rendered.headings import measure
    from experiments.rendered.tables import distance_table
    from services.features.pipeline.named_pipelines import find_profile
    from services.features.pipeline.pipeline import Pipeline
    from services.launcher.client.environments import environment_of
    from services.launcher.client.failure import ExperimentError
    from services.launcher.terminal.output import print_figures, print_rows, wide_console, write_json
    from services.planner.profiles import profile_named
    from simulator.world.world_file import load_world

    if tours is not None and recording is not None:
        raise ExperimentError("expected --tours or --recording, got both: calibrate on one at a time")
    place = environment_of(world)
    name = pipeline or ("photo" if tours is not None else "sift")
    chosen = Pipeline(find_profile(name))
    base = place.profile(base) or (name if name.startswith("photo") else "default")
    rules = profile_named(base)
    counts = rules.sensing.similarity
    if counts == "raw" and (tours is not None or recording is not None):
        raise ExperimentError(
            f"--base {base} counts matches up to the very goal: calibrate it in a world, without --tours and "
            "--recording"
        )
    facts: dict[str, Any] = {"pipeline": name, "seed": seed}
    rows: list[dict[str, Any]] = []
    with wide_console(stderr=True).status("") as status:
        if tours is not None:
            facts["tours"] = str(tours)
            found, alike = pairs_of_tours(read_tours(tours), chosen, rules, seed, status.update)
            proposal = propose(found, place.spans, doubtful=True, look_alikes=alike)
        elif recording is not None:
            facts["recording"] = str(recording)
            found = pairs_of_recording(recording, chosen, pairs, seed, place.spans.pair_m, status.update)
            proposal, rows = propose(found, place.spans, doubtful=True), distance_rows(found)
        else:
            facts["world"] = world
            results = measure(
                load_world(world), chosen, pairs, seed, data_dir, status.update, place.spans.pair_m
            )
            found, rows = [of_rendering(result, rules) for result in results], distance_table(results)
            proposal = (
                propose(found, place.spans)
                if counts == "verified"
                else propose_by_count(found, place.spans, chosen.profile.keypoints)
            )
    facts |= {"pairs": len(found), "wrong": sum(pair.is_wrong for pair in found)}
    write_json(json_file, {**facts, "thresholds": proposal, "by_distance": rows})
    write_json(write, {"base": base, "thresholds": proposal, "measured": facts})
    print_rows(f"{name} by distance", rows)
    print_figures("proposed thresholds", proposal)
