"""`topnav status`: how the stack of a data folder is."""

import typer

from services.launcher.terminal import options

app = typer.Typer()


@app.command()
def status(data_dir: options.StackDir = options.DATA_DIR, as_json: options.AsJson = False) -> None:
    """Show the stack of a data folder; exit 1 unless every service is healthy."""
    from rich.console import Console

    from services.launcher.processes.state import StateFolder
    from services.launcher.terminal.services import status_table

    state = StateFolder(data_dir.resolve()).read()
    if as_json:
        typer.echo(state.model_dump_json(indent=2) if state else "null")
    elif state is None:
        typer.echo(f"no stack runs in {data_dir}; start one with 'topnav up'")
    else:
        console = Console()
        console.print(status_table(state.services))
        console.print(
            f"console {state.gateway_url}  bus {state.endpoint}  logs {state.logs}", highlight=False
        )
        if state.silent:
            who = f"the launcher (pid {state.launcher_pid})"
            console.print(
                f"[bold red]{who} has been silent for {state.silent_s:.0f} s[/bold red]: "
                "nothing that dies is started again; 'topnav down', then 'topnav up'"
            )
    raise typer.Exit(0 if state and state.healthy else 1)
