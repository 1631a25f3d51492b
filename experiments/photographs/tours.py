"""Tours: folders of equirectangular pictures of one place, read and checked."""

import json
from collections.abc import Sequence
from dataclasses import dataclass
from itertools import combinations
from pathlib import Path

import numpy as np
from PIL import Image, UnidentifiedImageError
from pydantic import ValidationError

from experiments.photographs.tour_file import TourFile, kind_of
from services.launcher.client.failure import ExperimentError

TOUR_FILE = "tour.json"
SUFFIXES = (".jpg", ".jpeg", ".png")


@dataclass(frozen=True)
class Tour:
    """A tour whose pictures are there.

    Attributes:
        file: what is known of it.
        paths: the picture files, in the order of `file.pictures`.
    """

    file: TourFile
    paths: tuple[Path, ...]

    def number(self, picture: str) -> int:
        """Position of a picture in `paths`."""
        return self.file.pictures.index(picture)

    def links(self) -> list[tuple[int, int, float]]:
        """All links as listed: numbers of `from` and `to`, bearing in degrees."""
        return [(self.number(one.source), self.number(one.to), one.bearing_deg) for one in self.file.links]

    def neighbours(self) -> dict[int, set[int]]:
        """Pictures linked with each picture that has a link, in either direction."""
        found: dict[int, set[int]] = {}
        for a, b, _ in self.links():
            found.setdefault(a, set()).add(b)
            found.setdefault(b, set()).add(a)
        return found

    def look_alikes(self) -> list[tuple[int, int]]:
        """Unlinked pairs of pictures of different rooms of one kind: two places that look alike."""
        rooms = [self.file.rooms.get(one) for one in self.file.pictures]
        linked = self.neighbours()
        return [
            (a, b)
            for (a, one), (b, other) in combinations(enumerate(rooms), 2)
            if one is not None and other is not None and one != other
            if kind_of(one) == kind_of(other) and b not in linked.get(a, ())
        ]


def foreign_pairs(tour_of: Sequence[int], most: int, rng: np.random.Generator) -> list[tuple[int, int]]:
    """Pairs of pictures of different tours: all where there are at most `most`, else so many of them.

    Args:
        tour_of: number of the tour of each picture.
        most: pairs wanted at most.
        rng: draws them.
    """
    of = np.asarray(tour_of)
    a, b = np.triu_indices(len(of), 1)
    different = of[a] != of[b]
    a, b = a[different], b[different]
    kept = np.arange(len(a)) if len(a) <= most else np.sort(rng.choice(len(a), most, replace=False))
    return [(int(a[k]), int(b[k])) for k in kept]


def read_tours(folder: Path) -> list[Tour]:
    """Every tour in a folder or anywhere below it, by path.

    Raises:
        ExperimentError: there is none, or one has a fault; it is named with its file and field.
    """
    files = sorted(folder.rglob(TOUR_FILE))
    if not files:
        raise ExperimentError(
            f"{folder}: expected a {TOUR_FILE} in it or in folders below, found none: deploy/PHOTOGRAPHS.md "
            "says how to write one, and --render-example DIR makes one to look at"
        )
    return [read_tour(file) for file in files]


def read_tour(path: Path) -> Tour:
    """One tour, its pictures checked by their first bytes.

    Raises:
        ExperimentError: it cannot be read, or a value, a picture or a picture's size does not fit.
    """
    try:
        file = TourFile.model_validate(json.loads(path.read_text(encoding="utf-8")))
    except ValidationError as error:
        raise ExperimentError(f"{path}: {'; '.join(_fault(one) for one in error.errors())}") from error
    except (OSError, ValueError, RecursionError) as error:
        raise ExperimentError(f"{path}: expected JSON, got {error}: mend the file") from error
    paths = tuple(_picture(path, one) for one in file.pictures)
    return Tour(file, paths)


def _fault(error: object) -> str:
    assert isinstance(error, dict)
    place, text = ".".join(str(part) for part in error["loc"]), str(error["msg"])
    if not place:  # our own check, which names the field itself
        return text.removeprefix("Value error, ")
    got = "nothing" if error["type"] == "missing" else repr(error["input"])[:60]
    return f"{place}: {text}, got {got}: correct it"


def _picture(tour: Path, picture: str) -> Path:
    names = [f"{picture}{suffix}" for suffix in SUFFIXES]
    path = next((tour.parent / name for name in names if (tour.parent / name).is_file()), None)
    if path is None:
        raise ExperimentError(
            f"{tour}: pictures: expected {names[0]} or {names[-1]} beside it for id {picture!r}, got "
            "neither: put the picture there, or take the id and its links out"
        )
    try:
        with Image.open(path) as opened:
            width_px, height_px = opened.size
    except (OSError, UnidentifiedImageError, Image.DecompressionBombError) as error:
        raise ExperimentError(
            f"{path}: expected a JPEG or PNG picture, got {error}: export it again"
        ) from error
    if width_px != 2 * height_px:
        raise ExperimentError(
            f"{path}: expected an equirectangular picture, twice as wide as high, got "
            f"{width_px} x {height_px}: export it uncropped from the camera's program"
        )
    return path
