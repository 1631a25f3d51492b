"""`topnav map check`, `repair`, `backup` and `restore`: maps stay what they were, or one is told."""

from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Annotated

import typer

from services.launcher.client.failure import ExperimentError
from services.launcher.client.map_access import database_url, open_store
from services.launcher.processes.state import StateFolder
from services.launcher.terminal import options
from services.launcher.terminal.tables import print_rows
from services.map_store.errors import MapError
from services.map_store.integrity.backup import back_up, file_of, put_back

Name = Annotated[str, typer.Argument(help="Name of the map.")]
AnyName = Annotated[str | None, typer.Argument(help="Name of the map; default: all.")]
Copy = Annotated[Path, typer.Argument(help="Copy of the whole database.")]


def check_maps(name: AnyName = None, data_dir: options.DataDir = options.DATA_DIR) -> None:
    """List everything that is damaged; exit with 1 if something is."""
    with open_store(data_dir) as store:
        answer = store.get("/check" if name is None else f"/maps/{name}/check")
        damage = answer.raise_for_status().json()["damage"]
    what = f"maps in {data_dir}" if name is None else f"map {name}"
    if not damage:
        typer.echo(f"{what}: no damage")
        return
    print_rows(f"damage: {what}", damage)
    raise typer.Exit(1)


def repair_map(name: Name, data_dir: options.DataDir = options.DATA_DIR) -> None:
    """Mend a map from its history; what is lost there too is removed, as a new revision."""
    with open_store(data_dir) as store:
        answer = store.post(f"/maps/{name}/repair", headers={"X-Topnav-Author": "repair"})
        told = answer.raise_for_status().json()
    for line in told["done"] or ["no damage"]:
        typer.echo(line)
    typer.echo(f"{told['map']} is at revision {told['revision']}")


def back_up_maps(file: Copy, data_dir: options.DataDir = options.DATA_DIR) -> None:
    """Copy all maps into one file, also while a stack is running."""
    with _one_line():
        number = back_up(file_of(database_url(data_dir)), file)
    typer.echo(f"{number} maps, {file.stat().st_size} bytes in {file}")


def restore_maps(file: Copy, data_dir: options.DataDir = options.DATA_DIR) -> None:
    """Put a backup in the place of all maps; only while no stack is running here."""
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
    try:
        yield
    except MapError as error:
        raise ExperimentError(str(error)) from error
