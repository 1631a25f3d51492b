"""`topnav doctor`: what this machine lacks for a run."""

import typer

from services.launcher.terminal import options

app = typer.Typer()


@app.command()
def doctor(data_dir: options.StackDir = options.DATA_DIR, as_json: options.AsJson = False) -> None:
    """Say what this machine lacks for a run and how to fix it; exit 1 when something is missing."""
    import json
    import os
    from dataclasses import asdict

    from rich.console import Console

    from services.launcher.processes.machine import examine
    from services.launcher.processes.stack_settings import Ports
    from services.launcher.terminal.services import check_table

    checks = examine(data_dir.resolve(), Ports.from_variables(os.environ))
    if as_json:
        typer.echo(json.dumps([asdict(check) for check in checks], indent=2))
    else:
        Console().print(check_table(checks), highlight=False)
    raise typer.Exit(0 if all(check.ok for check in checks) else 1)
