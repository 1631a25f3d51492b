"""`topnav place`: names of places and areas in a map."""

from typing import Annotated, Any

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
    from services.launcher.client.marks import Marks

    Marks("place", map_name, data_dir).list(_row, as_json, search)


@app.command("name")
def name_place(
    name: Name, nodes: Nodes, map_name: options.MapName = "flat", data_dir: options.DataDir = options.DATA_DIR
) -> None:
    """Give nodes a name: one is a place, several are an area. A name that exists gets these nodes."""
    from services.launcher.client.marks import Marks

    revision = Marks("place", map_name, data_dir).put({"name": name, "nodes": nodes})
    typer.echo(f"{name}: nodes {', '.join(map(str, nodes))} of {map_name}, revision {revision}")


@app.command("forget")
def forget_place(
    name: Name, map_name: options.MapName = "flat", data_dir: options.DataDir = options.DATA_DIR
) -> None:
    """Forget a name; its nodes stay in the map."""
    from services.launcher.client.marks import Marks

    Marks("place", map_name, data_dir).forget(name)


def _row(place: dict[str, Any]) -> dict[str, str]:
    return {"place": str(place["name"]), "nodes": ", ".join(map(str, place["nodes"]))}
