"""`topnav study recovery`: a robot that is carried away, a goal that is elsewhere, a door that was shut."""

from collections.abc import Callable
from itertools import product
from typing import Annotated, Any

import typer

from experiments.work.record import on_record
from services.launcher.terminal import options

app = typer.Typer()

KINDS = ("carried", "foreign", "shut-door")


@app.command("recovery")
@on_record("study recovery")
def recovery(
    world: options.World = "apartment",
    map_name: options.MapName = "flat",
    elsewhere: Annotated[str, typer.Option(help="World that the foreign pictures come from.")] = "village",
    door_m: Annotated[
        tuple[float, float, float], typer.Option(help="Middle of the only door and its heading (degrees).")
    ] = (1.65, -0.1, 90.0),
    trials: Annotated[int, typer.Option(min=1, help="Trials of each kind.")] = 10,
    only: Annotated[str, typer.Option(help=f"One of {', '.join(KINDS)}; default: all.")] = "",
    seed: options.Seed = 1,
    json_file: options.JsonFile = None,
    data_dir: options.DataDir = options.DATA_DIR,
    timeout_s: options.TimeoutS = options.START_TIMEOUT_S,
) -> int:
    """Carried robots, pictures from elsewhere, a shut door: each ends well or says by name why not."""
    import numpy as np

    from experiments.driving.recovery import carried, foreign, foreign_pictures, shut_door, summary
    from services.launcher.client.maps import require_map
    from services.launcher.client.stack import StackChoice, open_stack
    from services.launcher.evaluation.rounds import Game
    from services.launcher.terminal.output import print_rows, write_json
    from simulator.world.freespace import free_space
    from simulator.world.world_file import load_world

    if only and only not in KINDS:
        raise typer.BadParameter(f"--only must be one of {', '.join(KINDS)}, got {only!r}")
    rng, rows = np.random.default_rng(seed), list[dict[str, Any]]()
    choice = StackChoice(data_dir, world, seed, lockstep=True, timeout_s=timeout_s)
    with open_stack(choice) as stack:
        require_map(stack, map_name)
        space = free_space(load_world(world))
        game = Game(stack, space, map_name, rng)
        game.begin(seed)
        pictures = foreign_pictures(elsewhere, trials, rng) if only in ("", "foreign") else []
        kinds: dict[str, Callable[[int], dict[str, Any]]] = {
            "carried": lambda n: carried(game, space, seed + n, rng),
            "foreign": lambda n: foreign(stack, game, map_name, pictures[n], seed + n),
            "shut-door": lambda n: shut_door(game, space, door_m, seed + n, rng),
        }
        for kind, number in product([only] if only else KINDS, range(trials)):
            rows.append({"kind": kind, "trial": number + 1, **kinds[kind](number)})
            write_json(json_file, {"world": world, "seed": seed, "trials": rows, "summary": summary(rows)})
    print_rows("trials", rows)
    print_rows("summary", summary(rows))
    return len(rows)
