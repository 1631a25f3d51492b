"""The folder of a world file, out of which nothing is read."""

import hashlib
import logging
import time
from dataclasses import replace
from pathlib import Path, PurePosixPath

from simulator.assets.model import AssetError, Model
from simulator.assets.model_cache import kept_model
from simulator.assets.model_file import SUFFIXES, read_model
from simulator.assets.picture_file import PICTURE_SUFFIXES, picture_from_bytes
from simulator.scene.disk_cache import DiskCache
from simulator.scene.parts import Picture

log = logging.getLogger(__name__)

TELL_S = 2.0  # between two lines about many models; chosen
MOST_BYTES = 64_000_000  # untrusted input: chosen, ten times a scanned chair
NAMED_SUFFIXES = (".mtl", ".bin")  # what a model may name beside pictures


class AssetFolder:
    """Reads models and pictures by their path relative to a folder, each file once."""

    def __init__(self, folder: Path, cache: DiskCache | None = None) -> None:
        """Use the folder of a world file; nothing is read yet. The cache keeps models as they were read."""
        self._root = folder.resolve()
        self._cache = cache or DiskCache.none()
        self._told_s = time.monotonic()
        self._models: dict[Path, Model] = {}
        self._pictures: dict[Path, Picture] = {}

    def model(self, name: str) -> Model:
        """Read a model, with the materials and pictures that it names.

        Raises:
            AssetError: it is not there, lies outside the folder, or is broken.
        """
        path = self._find(name, SUFFIXES)
        if path not in self._models:
            data = self.read(path)
            model = kept_model(
                path.name, data, self._cache, lambda: read_model(path, data, self._beside(path))
            )
            self._models[path] = replace(model, cache=self._cache)
            self._tell(path.name)
        return self._models[path]

    def _tell(self, name: str) -> None:
        """Say every few seconds how far it is."""
        now_s = time.monotonic()
        if now_s - self._told_s > TELL_S:
            self._told_s = now_s
            log.info("%d models read, the last is %s", len(self._models), name)

    def picture(self, name: str) -> Picture:
        """Read a picture; raises AssetError as `model` does."""
        path = self._find(name, PICTURE_SUFFIXES)
        if path not in self._pictures:
            self._pictures[path] = picture_from_bytes(self.read(path), path.name)
        return self._pictures[path]

    def _beside(self, model: Path) -> "_Beside":
        return _Beside(self, model.parent.relative_to(self._root))

    def _find(self, name: object, suffixes: tuple[str, ...]) -> Path:
        if not isinstance(name, str) or not name or "\0" in name:
            raise AssetError(f"must be a path relative to the world file, got {name!r:.80}")
        if Path(name).suffix.lower() not in suffixes:
            raise AssetError(
                f"{name!r:.120} must end in {', '.join(suffixes)}; export or convert it to one of these"
            )
        return self.inside(name)

    def inside(self, name: str) -> Path:
        """Absolute path of a file of the folder; AssetError if it is elsewhere or not there."""
        try:
            path = (self._root / name).resolve()
        except (OSError, RuntimeError, ValueError) as error:
            raise AssetError(f"{name!r:.120} is no usable path: {error}") from error
        if Path(name).is_absolute() or not path.is_relative_to(self._root):
            raise AssetError(
                f"{name!r:.120} must lie in the world's folder {self._root}, got {path}; copy it there"
            )
        if not path.is_file():
            raise AssetError(f"{name!r:.120}: no such file in {self._root}; paths count from the world file")
        return path

    def read(self, path: Path) -> bytes:
        """Content of a file of the folder; AssetError if it is too large or cannot be read."""
        try:
            size = path.stat().st_size
            if size > MOST_BYTES:
                raise AssetError(
                    f"{path.name} must be at most {MOST_BYTES // 1_000_000} MB, got {size / 1e6:.1f}"
                )
            return path.read_bytes()
        except OSError as error:
            raise AssetError(f"{path.name} cannot be read: {error.strerror or error}") from error


class _Beside:
    """What a model names: files relative to the model's own folder. Keeps the faults."""

    def __init__(self, assets: AssetFolder, folder: Path) -> None:
        self._assets, self._folder = assets, folder
        self.faults: list[str] = []
        self._digest = hashlib.sha256()

    def read(self, name: str) -> bytes:
        """Content of a file that the model names; a fault is kept, as the reader would pass over it."""
        try:
            path = self._assets.inside(str(PurePosixPath(self._folder) / name.replace("\\", "/")))
            data = self._assets.read(path)
            if path.suffix.lower() in PICTURE_SUFFIXES:
                picture_from_bytes(data, path.name)
            elif path.suffix.lower() not in NAMED_SUFFIXES:
                raise AssetError(
                    f"{path.name} must end in {', '.join((*PICTURE_SUFFIXES, *NAMED_SUFFIXES))}; convert it"
                )
        except AssetError as error:
            self.faults.append(str(error))
            raise
        self._digest.update(data)
        return data

    def digest(self) -> bytes:
        """Hash of all that was read."""
        return self._digest.digest()
