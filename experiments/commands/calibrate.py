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
    from experiments.calibration.proposal import Asked, of_recording, of_tours, of_world
    from services.features.pipeline.named_pipelines import find_profile
    from services.features.pipeline.pipeline import Pipeline
    from services.launcher.client.environments import environment_of
    from services.launcher.client.failure import ExperimentError
    from services.launcher.terminal.output import print_figures, print_rows, wide_console, write_json
    from services.planner.profiles import profile_name_for, profile_named

    if tours is not None and recording is not None:
        raise ExperimentError("expected --tours or --recording, got both: calibrate on one at a time")
    place = environment_of(world)
    name = pipeline or ("photo" if tours is not None else "sift")
    rules = profile_named(place.profile(base) or profile_name_for(name))
    facts: dict[str, Any] = {"pipeline": name, "seed": seed}
    with wide_console(stderr=True).status("") as status:
        asked = Asked(Pipeline(find_profile(name)), rules, place.spans, pairs, seed, status.update)
        if tours is not None:
            facts["tours"], found = str(tours), of_tours(asked, tours)
        elif recording is not None:
            facts["recording"], found = str(recording), of_recording(asked, recording)
        else:
            facts["world"], found = world, of_world(asked, world, data_dir)
    facts |= {"pairs": len(found.pairs), "wrong": sum(pair.is_wrong for pair in found.pairs)}
    write_json(json_file, {**facts, "thresholds": found.thresholds, "by_distance": found.rows})
    write_json(write, {"base": rules.name, "thresholds": found.thresholds, "measured": facts})
    print_rows(f"{name} by distance", found.rows)
    print_figures("proposed thresholds", found.thresholds)
