"""Textures of materials, from the cache or drawn, several at a time while the caller does other work."""

import os
from collections.abc import Iterable
from concurrent.futures import Future, ThreadPoolExecutor
from pathlib import Path
from types import TracebackType
from typing import Self

from simulator import textures
from simulator.scene.disk_cache import DiskCache, code_fingerprint, fingerprint
from simulator.scene.parts import Material, Picture
from simulator.textures.catalogue import draw
from simulator.textures.noise import Image

MOST_THREADS = 4  # chosen: more wait for one another's memory
Drawn = tuple[str, tuple[int, int, int], int]
Look = Drawn | Picture


def look_of(material: Material) -> Look:
    """What decides the texture of a material."""
    return material.picture or _drawn(material)


def _drawn(material: Material) -> Drawn:
    return material.kind, material.colour, material.seed


class Painter:
    """Draws ahead what was ordered; NumPy and OpenCV, which do most of it, let other threads run."""

    def __init__(self, cache: DiskCache) -> None:
        """Start the threads; leave the `with` block to end them."""
        self._cache = cache
        self._code = code_fingerprint(Path(textures.__file__).parent.glob("*.py"))
        self._pool = ThreadPoolExecutor(min(MOST_THREADS, os.cpu_count() or 1), "painter")
        self._ordered: dict[Drawn, Future[Image]] = {}

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self._pool.shutdown(cancel_futures=True)
        self._ordered.clear()

    def order(self, materials: Iterable[Material]) -> None:
        """Begin with these materials, in this order, and return at once."""
        for material in materials:
            look = _drawn(material)
            if material.picture is None and look not in self._ordered:
                self._ordered[look] = self._pool.submit(self._paint, *look)

    def take(self, material: Material) -> Image:
        """Wait for the texture of a material, and forget it; (height, width, 3) RGB bytes, 4 with holes."""
        if material.picture is not None:
            return material.picture.pixels
        self.order([material])
        return self._ordered.pop(_drawn(material)).result()

    def _paint(self, kind: str, colour: tuple[int, int, int], seed: int) -> Image:
        key = fingerprint("texture", self._code, kind, tuple(int(c) for c in colour), int(seed))
        return self._cache.fetch(key, lambda: [draw(kind, colour, seed)])[0]
