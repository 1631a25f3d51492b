"""`topnav down`: stop the launcher of a data folder, which stops its services."""

from typing import Annotated

import typer

from services.launcher.terminal import options

app = typer.Typer()


@app.command()
def down(
    data_dir: options.StackDir = options.DATA_DIR,
    timeout_s: Annotated[float, typer.Option(help="Kill the launcher after this.")] = 30.0,
) -> None:
    """Stop the stack of a data folder."""
    from services.launcher.processes.running import stop_stack

    typer.echo(stop_stack(data_dir.resolve(), timeout_s))
