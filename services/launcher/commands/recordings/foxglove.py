"""`topnav foxglove`: a recording for Foxglove, which reads no msgpack."""

from pathlib import Path
from typing import Annotated

import typer

app = typer.Typer()


@app.command()
def foxglove(
    file: Annotated[Path, typer.Argument(help="A file of 'topnav record'; a broken one up to the damage.")],
    out: Annotated[Path, typer.Argument(help="MCAP file to write, for Foxglove.")],
) -> None:
    """Convert a recording for Foxglove: pictures, distances, arrows, decisions, and all numbers for plots."""
    from services.launcher.terminal.output import print_rows
    from services.recorder.foxglove.export import export
    from services.recorder.foxglove.forms import load_drawings

    load_drawings()  # says what to install before the next line fails
    from services.launcher.drawing.true_pose import draw_true_pose

    done = export(file, out, draw_true_pose)
    rows = [{"channel": name, "messages": count} for name, count in sorted(done.counts.items())]
    print_rows(f"{out}, {out.stat().st_size / 1e6:.1f} MB", rows)
    for key, (count, reason) in done.left_out.items():
        typer.echo(f"left out: {count} of {key} ({reason})")
    if done.problem:
        typer.echo(f"{file} ends early ({done.problem}): what follows is not in {out}")
