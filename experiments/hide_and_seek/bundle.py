"""A map with its truth as one value, which travels to the worker that plays rounds on it."""

import json
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import httpx

from services.launcher.client.failure import ExperimentError
from services.launcher.client.maps import post_archive, store_client
from services.launcher.client.stack import Stack
from services.launcher.terminal.output import write_json


@dataclass(frozen=True)
class MapBundle:
    """An explored map.

    Attributes:
        archive: what `topnav map export` writes.
        truth: text of the truth file.
        figures: of the exploration, as `topnav explore --json` has them.
    """

    archive: bytes
    truth: str
    figures: dict[str, Any]


def export_map(stack: Stack, name: str) -> bytes:
    """The archive of a map of a stack that this process runs."""
    with _client(stack) as client:
        return client.get(f"/maps/{name}/export").raise_for_status().content


def import_map(stack: Stack, name: str, archive: bytes) -> None:
    """Put a map into a stack that this process runs."""
    with _client(stack) as client:
        post_archive(client, archive, name)


def save_bundle(folder: Path, bundle: MapBundle) -> None:
    """Write a bundle; the figures come last and mark it as whole."""
    folder.mkdir(parents=True, exist_ok=True)
    (folder / "map.zip").write_bytes(bundle.archive)
    (folder / "truth.json").write_text(bundle.truth, encoding="utf-8")
    write_json(folder / "explore.json", bundle.figures)


def load_bundle(folder: Path) -> MapBundle | None:
    """Read a bundle; None where there is no whole one."""
    if not (folder / "explore.json").exists():
        return None
    return MapBundle(
        (folder / "map.zip").read_bytes(),
        (folder / "truth.json").read_text(encoding="utf-8"),
        json.loads((folder / "explore.json").read_text(encoding="utf-8")),
    )


def _client(stack: Stack) -> httpx.Client:
    if stack.launcher is None:
        raise ExperimentError("suites start stacks of their own: stop the one in this folder first")
    return store_client(stack.launcher.map_store_url, stack.launcher.certs)
