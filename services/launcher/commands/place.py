"""`topnav place`: names of places and areas in a map."""

import json
from typing import Annotated

import typer

from services.launcher.terminal import options

app = typer.Typer(name="place", no_args_is_help=True, help="Name places of a map, to drive to by name.")

Name = Annotated[str, typer.Argument(help="Name of the place: kitchen, room 214, home.")]
Nodes = Annotated[list[int], typer.Argument(min=0, help="Its nodes; the first is the one to drive to.")]
Search = Annotated[str, typer.Option(help="Only names that hold this, and names like it.")]


@app.command("list")
def list_places(
    map_name: options.MapName = "flat",
    search: Search = "",
    data_dir: options.DataDir = options.DATA_DIR,
    as_json: options.AsJson = False,
) -> None:
    """Show the named places of a map."""
    from services.launcher.client.maps import open_store
    from services.launcher.terminal.output import print_rows

    with open_store(data_dir) as store:
        answer = store.get(f"/maps/{map_name}/places", params={"search": search})
        places = answer.raise_for_status().json()
    if as_json:
        typer.echo(json.dumps(places, indent=2))
        return
    rows = [{"place": place["name"], "nodes": ", ".join(map(str, place["nodes"]))} for place in places]
    print_rows(f"places of {map_name}", rows)


@app.command("name")
def name_place(
    name: Name, nodes: Nodes, map_name: options.MapName = "flat", data_dir: options.DataDir = options.DATA_DIR
) -> None:
    """Give nodes a name: one is a place, several are an area. A name that exists gets these nodes."""
    from services.launcher.client.maps import open_store

    with open_store(data_dir) as store:
        body = {"name": name, "nodes": nodes}
        revision = store.put(f"/maps/{map_name}/places", json=body).raise_for_status().json()["revision"]
    typer.echo(f"{name}: nodes {', '.join(map(str, nodes))} of {map_name}, revision {revision}")


@app.command("forget")
def forget_place(
    name: Name, map_name: options.MapName = "flat", data_dir: options.DataDir = options.DATA_DIR
) -> None:
    """Forget a name; its nodes stay in the map."""
    from services.launcher.client.maps import open_store

    with open_store(data_dir) as store:
        store.delete(f"/maps/{map_name}/places", params={"name": name}).raise_for_status()
    typer.echo(f"{name} is no place of {map_name} any more")
