"""`topnav map`: list, export, import, rename and delete maps over the map store's REST interface."""

from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Annotated

import httpx
import typer

from experiments import options
from experiments.failure import one_line_errors
from experiments.map_client import token_header
from experiments.tables import print_rows
from services.launcher.state import StateFolder
from services.launcher.supervisor import Launcher

app = typer.Typer(add_completion=False, pretty_exceptions_enable=False, no_args_is_help=True)

TIMEOUT_S = 120.0
Name = Annotated[str, typer.Argument(help="Name of the map.")]
File = Annotated[Path, typer.Argument(help="Archive file.")]
NewName = Annotated[str | None, typer.Option("--name", help="Import under this name.")]


@app.callback()
def choose() -> None:
    """List, export, import, rename and delete maps."""


@app.command("list")
def list_maps(data_dir: options.DataDir = options.DATA_DIR) -> None:
    """Show all maps."""
    with _store(data_dir) as store:
        rows = store.get("/maps").raise_for_status().json()
    print_rows(f"maps in {data_dir}", rows)


@app.command("export")
def export_map(name: Name, file: File, data_dir: options.DataDir = options.DATA_DIR) -> None:
    """Write a map to an archive file."""
    new = file.with_name(file.name + ".new")
    with _store(data_dir) as store, store.stream("GET", f"/maps/{name}/export") as answer:
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
    with _store(data_dir) as store:
        answer = store.post("/maps/import", params=params, headers=headers, content=file.read_bytes())
    typer.echo(f"imported {answer.raise_for_status().json()['name']}")


@app.command("rename")
def rename_map(
    name: Name,
    new: Annotated[str, typer.Argument(help="Its new name.")],
    data_dir: options.DataDir = options.DATA_DIR,
) -> None:
    """Give a map another name."""
    with _store(data_dir) as store:
        store.patch(f"/maps/{name}", json={"name": new}).raise_for_status()
    typer.echo(f"{name} is now {new}")


@app.command("delete")
def delete_map(name: Name, data_dir: options.DataDir = options.DATA_DIR) -> None:
    """Delete a map with its history."""
    with _store(data_dir) as store:
        store.delete(f"/maps/{name}").raise_for_status()
    typer.echo(f"{name} is deleted")


@contextmanager
def _store(data_dir: Path) -> Iterator[httpx.Client]:
    """A client of the running map store, or of one started for this command."""
    running = StateFolder(data_dir.resolve()).read()
    with one_line_errors():
        if running is not None:
            with _client(running.map_store_url) as client:
                yield client
            return
        with Launcher(data_dir, only=["map-store"]) as launcher, _client(launcher.map_store_url) as client:
            yield client


def _client(url: str) -> httpx.Client:
    return httpx.Client(base_url=url, headers=token_header(), timeout=TIMEOUT_S, trust_env=False)
