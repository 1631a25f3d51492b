"""`topnav soak`: hours of missions under chaos; exit 1 when an invariant did not hold."""

from typing import Annotated

import typer

from services.launcher.terminal import options

app = typer.Typer()


@app.command()
def soak(
    hours: Annotated[float, typer.Option(min=0.001, help="How long, with what --json has already.")] = 1.0,
    chaos: Annotated[bool, typer.Option(help="Kill, freeze and cut off at random.")] = True,
    world: options.World = "apartment",
    map_name: options.MapName = "flat",
    seed: options.Seed = 1,
    json_file: options.JsonFile = None,
    most_mb: Annotated[float, typer.Option(help="Memory that no service may pass, MB.")] = 2000.0,
    most_growth: Annotated[
        float, typer.Option(help="Growth that no service may pass once half an hour is known, MB/h.")
    ] = 100.0,
    data_dir: options.DataDir = options.DATA_DIR,
    timeout_s: options.TimeoutS = options.START_TIMEOUT_S,
) -> None:
    """Missions without end while services break.

    Never a collision, no acknowledged write lost, memory bounded, every mission ends in success or a failure
    with a name. A file of the same options is gone on with.
    """
    from experiments.soak.journal import Journal
    from experiments.soak.network import enter_own_network
    from experiments.soak.session import Plan, judge_growth, soak
    from services.launcher.client.failure import ExperimentError
    from services.launcher.client.maps import require_map
    from services.launcher.client.stack import StackChoice, open_stack
    from services.launcher.terminal.output import print_rows

    plan = Plan(world, map_name, seed, hours, most_mb, chaos, chaos and enter_own_network())
    journal = Journal(json_file, {"world": world, "map": map_name, "seed": seed, "chaos": chaos})
    choice = StackChoice(data_dir, world, seed, lockstep=False, timeout_s=timeout_s)
    with open_stack(choice) as stack:
        require_map(stack, map_name)
        journal.start()
        soak(stack, plan, journal)
    judge_growth(journal, most_growth)
    journal.write()
    summary = journal.summary()
    memory = [{"service": service, **found} for service, found in summary.pop("growth").items()]
    print_rows("soak", [{"figure": name, "value": str(value)} for name, value in summary.items()])
    print_rows("memory", memory)
    if journal.violations:
        raise ExperimentError(f"{journal.violations} violations of an invariant, see above and --json")
