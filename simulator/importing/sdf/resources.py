"""Where the files lie that a world names: model://, package://, file://, Fuel's addresses and paths."""

import os
import xml.etree.ElementTree as ElementTree
from collections.abc import Sequence
from pathlib import Path
from urllib.parse import unquote

from simulator.importing.entities import MissingFileError, WorldImportError

VARIABLES = ("GZ_SIM_RESOURCE_PATH", "IGN_GAZEBO_RESOURCE_PATH", "GAZEBO_MODEL_PATH", "GAZEBO_RESOURCE_PATH")
"""Gazebo's own search paths, newest first."""
HOMES = (".gazebo/models", ".gz/models", ".ignition/models")
"""Where Gazebo keeps models in a home folder."""
FUEL_HOMES = (".gz/fuel", ".ignition/fuel")
MOST_BYTES = 64_000_000  # untrusted input: as of a model file


class Resources:
    """Finds files by URI in the world's folder, the folders given, and Gazebo's search paths."""

    def __init__(self, world: Path, folders: Sequence[Path] = ()) -> None:
        """Search for what `world` names."""
        beside = world.resolve().parent
        near = [up / part for up in (beside, beside.parent) for part in ("models", ".")]
        paths = [Path(p) for name in VARIABLES for p in os.environ.get(name, "").split(os.pathsep) if p]
        roots = (*folders, *near, *paths, *(Path.home() / home for home in HOMES))
        self._roots = list(dict.fromkeys(root.resolve() for root in roots))

    def find(self, uri: str, beside: Path) -> Path:
        """File or folder of a URI; plain paths count from the folder `beside`.

        Raises:
            MissingFileError: it is nowhere, or has to be downloaded first.
            WorldImportError: it is no URI that can be read.
        """
        text = unquote(uri.strip())
        scheme, mark, rest = text.partition("://")
        if not text or "\0" in text:
            raise WorldImportError(f"uri must name a file, got {uri!r:.80}")
        if not mark:
            tried = [beside / text, *(root / text for root in self._roots)]
        elif scheme in {"model", "package"}:
            tried = [root / rest for root in self._roots]
        elif scheme == "file":
            tried = [Path(rest), beside / rest, *(root / rest for root in self._roots)]
        elif scheme in {"http", "https"}:
            return self._downloaded(text, rest)
        else:
            raise WorldImportError(f"{uri!r:.200} must begin with model://, package://, file:// or be a path")
        for path in tried:
            try:
                if path.exists():
                    return path.resolve()
            except OSError:  # a name too long for the system
                continue
        folders = ", ".join(dict.fromkeys(str(root) for root in (beside, *self._roots) if root.is_dir()))
        raise MissingFileError(f"{uri!r:.200} is not in {folders:.500}")

    def model_file(self, uri: str, beside: Path) -> Path:
        """The SDF file of an included model, newest version first, by its model.config.

        Raises:
            MissingFileError: the model is nowhere.
            WorldImportError: it has no such file.
        """
        folder = self.find(uri, beside)
        if folder.is_file():
            return folder
        config = folder / "model.config"
        if not config.is_file():
            if (folder / "model.sdf").is_file():
                return folder / "model.sdf"
            raise WorldImportError(f"{folder} must hold model.config or model.sdf, it has neither")
        named = [one for one in read_xml(config).iter("sdf") if one.text]
        named.sort(key=lambda one: _version(one.get("version", "0")), reverse=True)
        for one in named:
            path = folder / (one.text or "").strip()
            if path.is_file():
                return path
        raise WorldImportError(
            f"{config} must name an .sdf file that is there; got {len(named)} that are not"
        )

    def _downloaded(self, uri: str, rest: str) -> Path:
        """What `gz fuel download` has kept of an address such as fuel.gazebosim.org/1.0/OWNER/models/NAME."""
        words = rest.split("/")
        if len(words) >= 5 and words[3] in {"models", "worlds"}:
            host, _, owner, kind, name, *files = words
            for home in FUEL_HOMES:
                kept = Path.home() / home / host / owner.lower() / kind / name.lower()
                versions = sorted((p for p in kept.glob("*") if p.name.isdigit()), key=lambda p: int(p.name))
                at = versions[-1].joinpath(*files[2:]) if versions else None
                if at is not None and at.exists():
                    return at.resolve()
        raise MissingFileError(f"{uri!r:.200} must be downloaded first: gz fuel download -u {uri!r:.200}")


def read_xml(path: Path) -> ElementTree.Element:
    """Root of an XML file; WorldImportError if it is none or too large."""
    try:
        return ElementTree.fromstring(read_bytes(path).strip())  # as Gazebo, blank lines before it pass
    except (ElementTree.ParseError, RecursionError, ValueError) as error:
        raise WorldImportError(f"{path} is not valid XML: {error!s:.160}") from error


def read_text(path: Path) -> str:
    """Content of a text file; WorldImportError as for `read_bytes`."""
    return read_bytes(path).decode("utf-8", errors="replace")


def read_bytes(path: Path, most: int = MOST_BYTES) -> bytes:
    """Content of a file; WorldImportError if it is too large or cannot be read."""
    try:
        size = path.stat().st_size
        if size > most:
            raise WorldImportError(f"{path} must be at most {most // 1_000_000} MB, got {size / 1e6:.1f}")
        return path.read_bytes()
    except OSError as error:
        raise WorldImportError(f"{path} cannot be read: {error.strerror or error}") from error


def _version(text: str) -> tuple[int, ...]:
    return tuple(int(part) for part in text.split(".") if part.isdigit())
