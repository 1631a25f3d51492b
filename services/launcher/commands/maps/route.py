"""`topnav route`: routes that were taught, and driving along them."""

from typing import Annotated, Any

import typer

from services.launcher.terminal import options

app = typer.Typer(name="route", no_args_is_help=True, help="Routes of a map: ways that a person drove once.")

Name = Annotated[str, typer.Argument(help="Name of the route.")]
Search = Annotated[str, typer.Option(help="Only names that hold this, and names like it.")]
Reverse = Annotated[bool, typer.Option("--reverse", help="From its end to its beginning.")]
Rounds = Annotated[int, typer.Option(min=0, help="How often; 0: until it is cancelled.")]


@app.command("list")
def list_routes(
    map_name: options.MapName = "flat",
    search: Search = "",
    data_dir: options.DataDir = options.DATA_DIR,
    as_json: options.AsJson = False,
) -> None:
    """Show the routes of a map."""
    from services.launcher.client.marks import Marks

    Marks("route", map_name, data_dir).list(_row, as_json, search)


@app.command("show")
def show_route(
    name: Name, map_name: options.MapName = "flat", data_dir: options.DataDir = options.DATA_DIR
) -> None:
    """Show the nodes of a route, in the order of driving."""
    from services.launcher.client.maps import open_store

    with open_store(data_dir) as store:
        answer = store.get(f"/maps/{map_name}/route", params={"name": name})
        route = answer.raise_for_status().json()
    typer.echo(f"{route['name']}: {', '.join(map(str, route['nodes']))}")
    for a, b in route["gaps"]:
        typer.echo(f"broken between {a} and {b}: no edge joins them any more")


@app.command("remove")
def remove_route(
    name: Name, map_name: options.MapName = "flat", data_dir: options.DataDir = options.DATA_DIR
) -> None:
    """Forget a route; its nodes stay in the map."""
    from services.launcher.client.marks import Marks

    Marks("route", map_name, data_dir).forget(name)


@app.command("drive")
def drive_route(
    name: Name,
    map_name: options.MapName = "flat",
    reverse: Reverse = False,
    rounds: Rounds = 1,
    max_steps: options.MaxSteps = 20_000,
    data_dir: options.DataDir = options.DATA_DIR,
    endpoint: options.Endpoint = None,
    timeout_s: options.TimeoutS = options.START_TIMEOUT_S,
    json_file: options.JsonFile = None,
) -> None:
    """Drive to the beginning of a route and along exactly its nodes."""
    from services.launcher.client import any_mission, stack
    from shared.messages.missions import MissionRequest

    parameters = {"route": name, "reverse": reverse, "rounds": rounds}
    request = MissionRequest(action="route", map=map_name, parameters=parameters, max_steps=max_steps)
    with stack.open_stack(stack.StackChoice(data_dir, endpoint=endpoint, timeout_s=timeout_s)) as opened:
        any_mission.run_mission(opened, request, json_file)


def _row(route: dict[str, Any]) -> dict[str, str]:
    gaps = ", ".join(f"{a} and {b}" for a, b in route["gaps"])
    return {
        "route": str(route["name"]),
        "nodes": ", ".join(map(str, route["nodes"])),
        "broken": f"between {gaps}" if gaps else "",
    }
