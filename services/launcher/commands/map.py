"""`topnav map`: list, export, import, rename, delete, check, repair, back up and restore maps."""

from pathlib import Path
from typing import Annotated

import typer

from services.launcher.client.map_access import open_store
from services.launcher.commands.map_care import back_up_maps, check_maps, repair_map, restore_maps
from services.launcher.terminal import options
from services.launcher.terminal.tables import print_rows

app = typer.Typer(add_completion=False, pretty_exceptions_enable=False, no_args_is_help=True)

Name = Annotated[str, typer.Argument(help="Name of the map.")]
File = Annotated[Path, typer.Argument(help="Archive file.")]
NewName = Annotated[str | None, typer.Option("--name", help="Import under this name.")]


@app.callback()
def choose() -> None:
    """List, move, check, mend and keep maps."""


@app.command("list")
def list_maps(data_dir: options.DataDir = options.DATA_DIR) -> None:
    """Show all maps."""
    with open_store(data_dir) as store:
        rows = store.get("/maps").raise_for_status().json()
    print_rows(f"maps in {data_dir}", rows)


@app.command("export")
def export_map(name: Name, file: File, data_dir: options.DataDir = options.DATA_DIR) -> None:
    """Write a map to an archive file."""
    new = file.with_name(file.name + ".new")
    with open_store(data_dir) as store, store.stream("GET", f"/maps/{name}/export") as answer:
        if answer.is_error:
            answer.read()
        answer.raise_for_status()
        with new.open("wb") as out:
            for chunk in answer.iter_bytes():
                out.write(chunk)
    new.replace(file)
    typer.echo(f"{name}: {file.stat().st_size} bytes in {file}")


@app.command("import")
def import_map(file: File, name: NewName = None, data_dir: options.DataDir = options.DATA_DIR) -> None:
    """Read a map from an archive file; it must not exist yet."""
    params = {"name": name} if name is not None else {}
    headers = {"Content-Type": "application/zip"}
    with open_store(data_dir) as store:
        answer = store.post("/maps/import", params=params, headers=headers, content=file.read_bytes())
    typer.echo(f"imported {answer.raise_for_status().json()['name']}")


@app.command("rename")
def rename_map(
    name: Name,
    new: Annotated[str, typer.Argument(help="Its new name.")],
    data_dir: options.DataDir = options.DATA_DIR,
) -> None:
    """Give a map another name."""
    with open_store(data_dir) as store:
        store.patch(f"/maps/{name}", json={"name": new}).raise_for_status()
    typer.echo(f"{name} is now {new}")


@app.command("delete")
def delete_map(name: Name, data_dir: options.DataDir = options.DATA_DIR) -> None:
    """Delete a map with its history."""
    with open_store(data_dir) as store:
        store.delete(f"/maps/{name}").raise_for_status()
    typer.echo(f"{name} is deleted")


app.command("check")(check_maps)
app.command("repair")(repair_map)
app.command("backup")(back_up_maps)
app.command("restore")(restore_maps)
