"""`topnav record`: everything that the processes of a running stack tell each other, in one file."""

from pathlib import Path
from typing import Annotated

import typer

from services.launcher.terminal import options

app = typer.Typer()


@app.command()
def record(
    file: Annotated[Path, typer.Argument(help="MCAP file to write.")],
    seconds: Annotated[float | None, typer.Option(min=0.1, help="Stop by itself; else Ctrl+C does.")] = None,
    without: Annotated[str, typer.Option(help='Topics to leave out, as "frame,features".')] = "",
    endpoint: options.Endpoint = None,
    data_dir: options.DataDir = options.DATA_DIR,
) -> None:
    """Write what the bus of a running stack says into an MCAP file, until Ctrl+C."""
    from services.launcher.client.address import running_address
    from services.launcher.terminal.output import print_rows, wide_console
    from services.recorder.channels import topics_named
    from services.recorder.recorder import record
    from services.recorder.recording import RecordingWriter
    from shared.lifecycle import stop_on_signals

    left_out = topics_named(without)
    address = running_address(endpoint, data_dir)
    stop = stop_on_signals()
    with RecordingWriter(file) as writer, address.open() as bus:
        text = f"recording {address.endpoint} into {file}; Ctrl+C ends it"
        wide_console(stderr=True).print(text, highlight=False)
        lost = record(bus, writer, left_out, stop, seconds).dropped()
    rows = [
        {"key": key, "messages": count, "lost": lost.get(key, 0)}
        for key, count in sorted(writer.counts.items())
    ]
    print_rows(f"{file}, {file.stat().st_size / 1e6:.1f} MB", rows)
