"""`topnav study inspection`: driven rounds of the mission inspect, with furniture moved between them."""

from typing import Annotated

import typer

from experiments.work.record import on_record
from services.launcher.terminal import options

app = typer.Typer()


@app.command("inspection")
@on_record("study inspection")
def inspection(
    world: options.World = "apartment",
    map_name: options.MapName = "flat",
    places: Annotated[int, typer.Option(min=1, max=64, help="Places of a round.")] = 6,
    rounds: Annotated[int, typer.Option(min=1, help="Rounds after the first.")] = 5,
    changes: Annotated[int, typer.Option(min=1, help="Pieces changed before each round.")] = 6,
    illumination: Annotated[
        float, typer.Option(min=0, max=1, help="Light of every other round; 0.3 is half of the daylight.")
    ] = 0.0,
    seed: options.Seed = 1,
    json_file: options.JsonFile = None,
    data_dir: options.DataDir = options.DATA_DIR,
    timeout_s: options.TimeoutS = options.START_TIMEOUT_S,
) -> int:
    """Inspect places of a map in rounds; pieces are taken away, moved and put back between them.

    With an illumination every round is compared with one in other light.
    """
    import numpy as np

    from experiments.changes.places import named_places
    from experiments.changes.rounds import Rounds
    from services.launcher.client.maps import open_store, require_map
    from services.launcher.client.stack import StackChoice, open_stack
    from services.launcher.evaluation.rounds import Game
    from services.launcher.terminal.output import print_rows, write_json
    from simulator.world.freespace import free_space
    from simulator.world.world_file import load_world

    rng, loaded = np.random.default_rng(seed), load_world(world)
    choice = StackChoice(data_dir, world, seed, lockstep=True, timeout_s=timeout_s)
    with open_stack(choice) as stack, open_store(data_dir) as store:
        require_map(stack, map_name)
        game = Game(stack, free_space(loaded), map_name, rng)
        game.begin(seed)
        chosen = named_places(stack, data_dir, map_name, places)
        rows = []
        told = {"world": world, "seed": seed, "map": map_name, "illumination": illumination}
        played = Rounds(game, store, map_name, loaded, chosen, rng, illumination)
        for row in played.play(rounds, changes, seed):
            rows.append(row)
            write_json(json_file, {**told, "rounds": rows})
    print_rows("rounds of inspecting", rows)
    return len(rows)
