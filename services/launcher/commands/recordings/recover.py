"""`topnav recover`: what is left of a recording that was cut off."""

from pathlib import Path
from typing import Annotated

import typer

app = typer.Typer()


@app.command()
def recover(
    file: Annotated[Path, typer.Argument(help="The broken recording; it is left as it is.")],
    out: Annotated[Path, typer.Argument(help="The new, whole one.")],
) -> None:
    """Save what is in a broken recording: every message up to the first damage, in a new one."""
    from services.recorder.recording import recover

    found = recover(file, out)
    state = "was whole" if found.whole else f"ends early ({found.problem})"
    typer.echo(f"{found.messages} messages in {out}; {file} {state}")
