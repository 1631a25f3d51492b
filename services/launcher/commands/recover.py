"""`topnav recover`: what is left of a recording that was cut off."""

from pathlib import Path
from typing import Annotated

import typer

from services.recorder.recovering import recover

app = typer.Typer(add_completion=False, pretty_exceptions_enable=False)


@app.command()
def main(
    file: Annotated[Path, typer.Argument(help="The broken recording; it is left as it is.")],
    out: Annotated[Path, typer.Argument(help="The new, whole one.")],
) -> None:
    """Copy every message up to the first damage into a new recording."""
    found = recover(file, out)
    state = "was whole" if found.whole else f"ends early ({found.problem})"
    typer.echo(f"{found.messages} messages in {out}; {file} {state}")
