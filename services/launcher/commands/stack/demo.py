"""`topnav demo`: explore an apartment nobody has seen, then find a hidden robot from one uploaded picture."""

import os
from pathlib import Path
from typing import Annotated

import typer

from services.launcher.terminal import options

app = typer.Typer()


@app.command()
def demo(
    world: options.World = "apartment",
    seed: options.Seed = 1,
    explore_steps: Annotated[int, typer.Option(min=1, help="Go seeking after so many at the latest.")] = 5000,
    runs: Annotated[Path, typer.Option(help="The report goes to a new folder in here.")] = options.RUNS_DIR,
    keep: Annotated[
        bool, typer.Option(envvar="KEEP", help="Leave everything and the web page up until Ctrl+C.")
    ] = False,
    timeout_s: options.TimeoutS = options.START_TIMEOUT_S,
) -> None:
    """Explore the apartment, then find a hidden robot from its picture; ends with the report's path."""
    from services.launcher.client.stack import StackChoice, open_stack
    from services.launcher.evaluation.demo import Scene, play, require_found
    from services.launcher.processes.stack_settings import Ports
    from services.launcher.terminal.output import new_run_folder, wide_console
    from shared.lifecycle import stop_on_signals
    from simulator.world.freespace import free_space
    from simulator.world.world_file import load_world

    console, file = wide_console(), load_world(world)
    scene = Scene(file, free_space(file), seed, new_run_folder(runs))
    # The documented ports where they are free: the console is where the README says.
    usual = Ports.from_variables(os.environ)
    ports = Ports.free() if usual.taken() else usual
    choice = StackChoice(scene.folder / "data", world, seed, lockstep=True, ports=ports, timeout_s=timeout_s)
    console.print(f"starting all services, logs in {choice.data_dir / 'launcher' / 'logs'}", highlight=False)
    with open_stack(choice) as stack:
        found = play(console, stack, scene, choice.data_dir, explore_steps)
        if keep:
            console.print(f"everything stays up on {stack.gateway_url}; stop it with Ctrl+C", highlight=False)
            stop_on_signals().wait()
    require_found(found)
