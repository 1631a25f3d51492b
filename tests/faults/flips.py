"""One byte of the database file changed, many times over: what the map store then makes of it."""

import shutil
from collections import Counter
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Literal

import numpy as np

from services.map_store.errors import MapError
from services.map_store.integrity.check import check
from services.map_store.storage.missions import MissionStore
from services.map_store.store import MapStore
from shared.messages.maps import DeleteNode
from tests.faults.lived_maps import ROBOT, live, opened, place, rows_of, told_of

Verdict = Literal["detected", "undetected", "unused"]
MAPS = ("attic", "flat", "house")


@dataclass(frozen=True)
class Flip:
    """One changed byte.

    Attributes:
        verdict: detected or undetected of a byte that is used; unused when every row is still what it was
            and stays so while maps are written.
        why: who noticed, or what went wrong.
        mended: whether a repair made everything as it was before; None where nothing was to be repaired.
    """

    offset: int
    was: int
    now: int
    verdict: Verdict
    why: str
    mended: bool | None = None


class Flipping:
    """A database and what is right about it; `flip` judges one byte changed in a copy.

    With `mend` it also repairs what was detected.
    """

    def __init__(self, folder: Path, mend: bool = True) -> None:
        self._folder, self._mend = folder, mend
        self.file = folder / "maps.sqlite3"
        live(self.file)
        store = opened(self.file)
        self._told = {name: told_of(store, name) for name in MAPS}
        self._rows = rows_of(store)
        store.database.close()
        self.size = self.file.stat().st_size

    def draw(self, rng: np.random.Generator) -> Flip:
        """Change one random byte."""
        return self.flip(int(rng.integers(self.size)), int(rng.integers(1, 256)))

    def flip(self, offset: int, mask: int) -> Flip:
        """Change the byte at `offset` by exclusive or with `mask`."""
        copy = self._folder / "copy.sqlite3"
        for old in self._folder.glob("copy.sqlite3*"):
            old.unlink()
        shutil.copyfile(self.file, copy)
        with copy.open("r+b") as file:
            file.seek(offset)
            was = file.read(1)[0]
            file.seek(offset)
            file.write(bytes([was ^ mask]))
        return Flip(offset, was, was ^ mask, *self._judge(copy))

    def _judge(self, file: Path) -> tuple[Verdict, str, bool | None]:
        try:
            store = opened(file)
        except MapError as error:
            return "detected", f"refused at start: {type(error).__name__}: {error}", None
        try:
            wrong = self._wrongly_told(store)
            if wrong:
                return "undetected", wrong, None
            found = check(store.database)
            if found:
                mended = self._mended(store) if self._mend else None
                return "detected", f"{found[0].map} {found[0].thing}: {found[0].reason}", mended
            wrong = self._harm(store, file)
            return ("undetected", wrong, None) if wrong else ("unused", "the same content", None)
        except MapError as error:
            return "detected", f"refused: {error}", None
        finally:
            store.database.close()

    def _wrongly_told(self, store: MapStore) -> str:
        """What is served and is not what was written; nothing may be, whatever else is noticed."""
        for name in MAPS:
            try:
                told = told_of(store, name)
            except MapError:
                continue
            for thing, value in told.items():
                if value is not None and value != self._told[name].get(thing):
                    return f"{name}: {thing} is told as {value!r:.300}"
            lacking = [t for t in self._told[name] if t not in told and not t.startswith("features")]
            if lacking:
                return f"{name}: {lacking[0]} is left out"
        return ""

    def _harm(self, store: MapStore, file: Path) -> str:
        """What a change that no check found did all the same: to a row, or to what is written from now on."""
        rows, expected = rows_of(store), self._rows
        different = [name for name in expected if rows[name] != expected[name]]
        if different:
            return f"rows of {different} differ"
        for name in MAPS:
            store.transact(name, [place(5_000 + number) for number in range(3)])
            store.transact(name, [DeleteNode(node_id=5_001)])
            store.undo(name)
            store.undo(name)
        MissionStore(store.database).claim(ROBOT)
        store.create("new")
        store.transact("new", [place(number) for number in range(8)])
        store.delete("new")
        store.database.close()
        again = opened(file)
        try:
            found = check(again.database)
            if found:
                return f"written on: {found[0].thing}: {found[0].reason}"
            kept = all(told_of(again, name).items() >= _lasting(self._told[name]) for name in MAPS)
        finally:
            again.database.close()
        return "" if kept else "written on: lost"

    def _mended(self, store: MapStore) -> bool | None:
        """Repair everything; whether all maps are again what they were."""
        try:
            for name in sorted({*MAPS, *(found.map for found in check(store.database))} - {""}):
                store.repair(name)
            if check(store.database):
                return None
            return all(_contents(told_of(store, name)) == _contents(self._told[name]) for name in MAPS)
        except MapError:
            return None


def flips(folder: Path, number: int, seed: int, mend: bool = True) -> Iterator[Flip]:
    """Change `number` random bytes, one at a time, each in a fresh copy."""
    flipping, rng = Flipping(folder, mend), np.random.default_rng(seed)
    for _ in range(number):
        yield flipping.draw(rng)


def figures(found: list[Flip]) -> dict[str, Any]:
    """How many were what."""
    verdicts = Counter(flip.verdict for flip in found)
    mended = Counter(flip.mended for flip in found if flip.verdict == "detected")
    return {
        "flips": len(found),
        "in_used_bytes": verdicts["detected"] + verdicts["undetected"],
        "detected": verdicts["detected"],
        "undetected": verdicts["undetected"],
        "in_unused_bytes": verdicts["unused"],
        "mended_without_loss": mended[True],
        "mended_with_losses": mended[False],
        "not_mended": mended[None],
    }


def _lasting(told: dict[str, Any]) -> Any:
    return {thing: v for thing, v in told.items() if thing not in ("revision", "record")}.items()


def _contents(told: dict[str, Any]) -> dict[str, Any]:
    return {thing: v for thing, v in told.items() if thing.startswith(("node", "edge", "features", "thumb"))}
