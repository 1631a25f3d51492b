"""`topnav replay`: a recording goes over the bus again, for the web page and for services under test."""

from pathlib import Path
from typing import Annotated

import typer

from services.launcher.terminal import options

app = typer.Typer()


@app.command()
def replay(
    file: Annotated[Path, typer.Argument(help="A file of 'topnav record'.")],
    rate: Annotated[float, typer.Option(min=0.01, help="2 plays twice as fast.")] = 1.0,
    remap: Annotated[
        list[str] | None, typer.Option(help="Other name of a robot, as r1=ghost; may be repeated.")
    ] = None,
    without: Annotated[str, typer.Option(help='Topics to leave out, as "command,heading".')] = "delta",
    loop: Annotated[bool, typer.Option("--loop", help="Begin again at the end, until Ctrl+C.")] = False,
    endpoint: options.Endpoint = None,
    data_dir: options.DataDir = options.DATA_DIR,
) -> None:
    """Play a recording, as if live: into a running stack, or into a web page started for it.

    Maps are those of the data folder. A robot that lives is never mixed with a recorded one: --remap it.
    """
    from services.launcher.client.replay_bus import new_names, open_replay_bus
    from services.launcher.terminal.output import print_rows, wide_console
    from services.recorder.channels import topic_of, topics_named
    from services.recorder.player import Player, play
    from services.recorder.reading import contents, read
    from shared.lifecycle import stop_on_signals

    names, left_out = new_names(remap or []), topics_named(without)
    index = contents(file)
    robots = {found[1].get("robot") for key in index.counts if (found := topic_of(key)) is not None}
    stop = stop_on_signals()
    unnamed = {robot for robot in robots if robot} - names.keys()
    with open_replay_bus(endpoint, data_dir, unnamed) as bus:
        player = Player(bus, names, left_out)
        console = wide_console(stderr=True)
        console.print(f"replaying {index.duration_s:.1f} s at rate {rate:g}; Ctrl+C ends it", highlight=False)
        again = True
        while again and not stop.is_set():
            play(read(file), player.put, rate, stop)
            again = loop
    print_rows(str(file), [{"key": key, "messages": n} for key, n in sorted(player.counts.items())])
