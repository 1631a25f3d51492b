"""`topnav study failures`: what went wrong in the thesis, by its rule and by ours."""

from collections.abc import Callable
from typing import Annotated, Any

import typer

from experiments.work.record import on_record
from services.launcher.terminal import options

app = typer.Typer()

KINDS = ("oscillation", "corner", "door", "truck", "long-edges")
DOOR_M, DOOR_RADIUS_M = (1.65, -0.1), 0.9
"""The apartment's inner door, in simulator/worlds/apartment.yaml."""

TRUCK_M, TRUCK_RADIUS_M = (29.0, 11.2), 3.0
"""The middle of the way along the lorry's plain side, in simulator/worlds/factory.yaml."""

LONG_M = 15.0
"""Further than streets of the village let anybody recognise a spot: nodes lie 2.5 to 4.5 m apart there."""


@app.command("failures")
@on_record("study failures")
def failures(
    only: Annotated[str, typer.Option(help=f"One of {', '.join(KINDS)}; default: all.")] = "",
    map_name: Annotated[
        str, typer.Option("--map", help="Explored map of the apartment (oscillation).")
    ] = "flat",
    village_map: Annotated[str, typer.Option(help="Explored map of the village (long-edges).")] = "village",
    rounds: Annotated[int, typer.Option(min=1, help="Rounds of the oscillation study.")] = 8,
    pairs: Annotated[int, typer.Option(min=10, help="Frame pairs of the heading studies.")] = 120,
    seed: options.Seed = 1,
    json_file: options.JsonFile = None,
    data_dir: options.DataDir = options.DATA_DIR,
) -> int:
    """Each failure of the thesis: reproduced with its rule, and the same work with ours."""
    from experiments.driving.thesis_failures import corner, oscillation
    from experiments.rendered.thesis_failures import long_edges, wrong_headings
    from services.launcher.terminal.output import print_rows, write_json
    from services.planner.profiles import DEFAULT

    studies: dict[str, Callable[[], dict[str, Any]]] = {
        "oscillation": lambda: oscillation(data_dir, "apartment", map_name, rounds, seed),
        "corner": lambda: corner("apartment", seed),
        "door": lambda: wrong_headings(
            data_dir, "apartment", "faulty headings at a door", DOOR_M, DOOR_RADIUS_M, pairs
        ),
        "truck": lambda: wrong_headings(
            data_dir, "factory", "false motion at the truck", TRUCK_M, TRUCK_RADIUS_M, pairs
        ),
        "long-edges": lambda: long_edges(data_dir, village_map, DEFAULT, LONG_M),
    }
    if only and only not in studies:
        raise typer.BadParameter(f"--only must be one of {', '.join(KINDS)}, got {only!r}")
    rows = []
    for name in [only] if only else KINDS:
        rows.append({**studies[name](), "command": f"topnav study failures --only {name}"})
        write_json(json_file, {"seed": seed, "results": rows})
    for row in rows:
        title = f"{row['failure']} ({row['command']})"
        print_rows(title, [{"rule": rule, **row[rule]} for rule in ("thesis", "ours")])
    return len(rows)
