"""`topnav map`: list, export, import, rename, delete, check, repair, back up and restore maps."""

from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Annotated

import typer

from services.launcher.terminal import options

app = typer.Typer(name="map", no_args_is_help=True, help="List, move, check, mend and keep maps.")

Name = Annotated[str, typer.Argument(help="Name of the map.")]
AnyName = Annotated[str | None, typer.Argument(help="Name of the map; default: all.")]
File = Annotated[Path, typer.Argument(help="Archive file.")]
Copy = Annotated[Path, typer.Argument(help="Copy of the whole database.")]
NewName = Annotated[str | None, typer.Option("--name", help="Import under this name.")]


@app.command("list")
def list_maps(data_dir: options.DataDir = options.DATA_DIR) -> None:
    """Show all maps."""
    from services.launcher.client.maps import open_store
    from services.launcher.terminal.output import print_rows

    with open_store(data_dir) as store:
        rows = store.get("/maps").raise_for_status().json()
    print_rows(f"maps in {data_dir}", rows)


@app.command("export")
def export_map(name: Name, file: File, data_dir: options.DataDir = options.DATA_DIR) -> None:
    """Write a map to an archive file; one that is there already is replaced."""
    import os
    import tempfile
    import zipfile

    from services.launcher.client.failure import ExperimentError
    from services.launcher.client.maps import open_store

    if file.exists() and not zipfile.is_zipfile(file):
        raise ExperimentError(f"{file} exists and is no archive of a map: name another file, or delete it")
    with tempfile.TemporaryDirectory(dir=file.parent, prefix=f".{file.name}-") as folder:
        new = Path(folder) / "archive.zip"
        with open_store(data_dir) as store, store.stream("GET", f"/maps/{name}/export") as answer:
            if answer.is_error:
                answer.read()
            answer.raise_for_status()
            with new.open("wb") as out:
                for chunk in answer.iter_bytes():
                    out.write(chunk)
                os.fsync(out.fileno())
        new.replace(file)
    typer.echo(f"{name}: {file.stat().st_size} bytes in {file}")


@app.command("import")
def import_map(file: File, name: NewName = None, data_dir: options.DataDir = options.DATA_DIR) -> None:
    """Read a map from an archive file; it must not exist yet."""
    from services.launcher.client.maps import open_store, post_archive

    with open_store(data_dir) as store:
        typer.echo(f"imported {post_archive(store, file.read_bytes(), name)}")


@app.command("rename")
def rename_map(
    name: Name,
    new: Annotated[str, typer.Argument(help="Its new name.")],
    data_dir: options.DataDir = options.DATA_DIR,
) -> None:
    """Give a map another name; an old one that begins with - goes behind --."""
    from services.launcher.client.maps import open_store

    with open_store(data_dir) as store:
        store.patch(f"/maps/{name}", json={"name": new}).raise_for_status()
    typer.echo(f"{name} is now {new}")


@app.command("delete")
def delete_map(name: Name, data_dir: options.DataDir = options.DATA_DIR) -> None:
    """Delete a map with its history."""
    from services.launcher.client.maps import open_store

    with open_store(data_dir) as store:
        store.delete(f"/maps/{name}").raise_for_status()
    typer.echo(f"{name} is deleted")


@app.command("check")
def check_maps(name: AnyName = None, data_dir: options.DataDir = options.DATA_DIR) -> None:
    """List everything that is damaged; exit with 1 if something is."""
    from services.launcher.client.maps import open_store
    from services.launcher.terminal.output import print_rows

    with open_store(data_dir) as store:
        answer = store.get("/check" if name is None else f"/maps/{name}/check")
        damage = answer.raise_for_status().json()["damage"]
    what = f"maps in {data_dir}" if name is None else f"map {name}"
    if not damage:
        typer.echo(f"{what}: no damage")
        return
    print_rows(f"damage: {what}", damage)
    raise typer.Exit(1)


@app.command("repair")
def repair_map(name: Name, data_dir: options.DataDir = options.DATA_DIR) -> None:
    """Mend a map from its history; what is lost there too is removed, as a new revision."""
    from services.launcher.client.maps import open_store

    with open_store(data_dir) as store:
        answer = store.post(f"/maps/{name}/repair", headers={"X-Topnav-Author": "repair"})
        repaired = answer.raise_for_status().json()
    for line in repaired["done"] or ["no damage"]:
        typer.echo(line)
    typer.echo(f"{repaired['map']} is at revision {repaired['revision']}")


@app.command("backup")
def back_up_maps(file: Copy, data_dir: options.DataDir = options.DATA_DIR) -> None:
    """Copy all maps into one file, also while a stack is running."""
    from services.launcher.client.maps import database_url
    from services.map_store.integrity.backup import back_up, file_of

    with _one_line():
        number = back_up(file_of(database_url(data_dir)), file)
    typer.echo(f"{number} maps, {file.stat().st_size} bytes in {file}")


@app.command("restore")
def restore_maps(file: Copy, data_dir: options.DataDir = options.DATA_DIR) -> None:
    """Put a backup in the place of all maps; only while no stack is running here."""
    from services.launcher.client.maps import database_url
    from services.launcher.processes.state import StateFolder
    from services.map_store.integrity.backup import file_of, put_back

    state = StateFolder(data_dir.resolve())
    state.acquire()
    try:
        with _one_line():
            target = file_of(database_url(data_dir))
            kept = put_back(file, target)
    finally:
        state.release()
    typer.echo(f"{target} is now {file}" + (f"; what was there is kept as {kept}" if kept else ""))


@contextmanager
def _one_line() -> Iterator[None]:
    from services.launcher.client.failure import ExperimentError
    from services.map_store.errors import MapError

    try:
        yield
    except MapError as error:
        raise ExperimentError(str(error)) from error
