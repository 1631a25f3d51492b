"""Marks on a map, as the commands about places, routes, rules and signs list and forget them."""

import json
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Literal

import typer

from services.launcher.client.maps import open_store
from services.launcher.terminal.output import print_rows


@dataclass(frozen=True)
class Marks:
    """Marks of one kind on one map, in the map store of the stack in `data_dir` or one of its own."""

    kind: Literal["place", "route", "rule", "sign"]
    map_name: str
    data_dir: Path

    def list(self, row: Callable[[dict[str, Any]], dict[str, str]], as_json: bool, search: str = "") -> None:
        """Print all, or those that a search finds: as JSON, or as a table with a `row` of each."""
        with open_store(self.data_dir) as store:
            marks = store.get(self._path, params={"search": search}).raise_for_status().json()
        if as_json:
            typer.echo(json.dumps(marks, indent=2))
            return
        print_rows(f"{self.kind}s of {self.map_name}", [row(mark) for mark in marks])

    def put(self, mark: dict[str, Any]) -> int:
        """Set one, or replace the one of its name; the map's revision then."""
        with open_store(self.data_dir) as store:
            revision: int = store.put(self._path, json=mark).raise_for_status().json()["revision"]
        return revision

    def forget(self, name: str) -> None:
        """Remove one and say so."""
        with open_store(self.data_dir) as store:
            store.delete(self._path, params={"name": name}).raise_for_status()
        typer.echo(f"{name} is no {self.kind} of {self.map_name} any more")

    @property
    def _path(self) -> str:
        return f"/maps/{self.map_name}/{self.kind}s"
