"""`topnav bench`: timings."""

import typer

from experiments.bench.loop import main as loop

app = typer.Typer(add_completion=False, pretty_exceptions_enable=False, no_args_is_help=True)
app.command("loop")(loop)


@app.callback()
def choose() -> None:
    """Time the control loop."""
