"""`topnav study changes`: what the comparison of two pictures of a place finds, and what it makes up."""

from typing import Annotated

import typer

from experiments.work.record import on_record
from services.launcher.terminal import options

app = typer.Typer()


@app.command("changes")
@on_record("study changes")
def changes(
    world: options.World = "apartment",
    generated: Annotated[
        str, typer.Option(help="Worlds by kind, seed and size instead, as flat-0-small,hotel-1-small.")
    ] = "",
    states: Annotated[int, typer.Option(min=1, help="How often pieces are changed in each world.")] = 6,
    most_m: Annotated[float, typer.Option(min=0.0, max=0.5, help="Largest distance of two spots.")] = 0.15,
    seed: options.Seed = 1,
    json_file: options.JsonFile = None,
) -> int:
    """Pairs of pictures with furniture taken away, brought, moved or nothing changed; half in half the light.

    A world takes about 20 s to build, each state 10 s, each pair 1 s.
    """
    import numpy as np

    from experiments.changes.sights import sights
    from experiments.changes.study import by_conditions, measured, summary
    from experiments.rendered.frames import simulated
    from experiments.training.worlds import WorldName
    from services.features.changes.comparison import Sensitivity
    from services.features.pipeline.named_pipelines import find_profile
    from services.features.pipeline.pipeline import Pipeline
    from services.launcher.terminal.output import print_rows, wide_console, write_json
    from simulator.world.freespace import free_space
    from simulator.world.world_file import load_world

    names = [each.strip() for each in generated.split(",")] if generated else [world]
    pipeline, rng, rows = Pipeline(find_profile("sift")), np.random.default_rng(seed), []
    with wide_console(stderr=True).status("") as status:
        for name in names:
            loaded = WorldName.parse(name).world() if generated else load_world(name)
            places = sights(simulated(loaded), free_space(loaded), states, most_m, rng)
            for row in measured(places, pipeline, rng):
                rows.append({"world": name, **row})
                status.update(f"{name}: place {row['sight'] + 1}")
    shown = by_conditions(rows, Sensitivity())
    settings = summary(rows)
    not_compared = sum(not row["compared"] for row in rows)
    report = {"worlds": names, "seed": seed, "states": states, "most_m": most_m, "not_compared": not_compared}
    write_json(json_file, {**report, "conditions": shown, "settings": settings})
    print_rows(f"changes reported in {', '.join(names)}", shown)
    return len(rows)
