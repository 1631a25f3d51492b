"""Furniture that an experimenter moves, takes away or adds while the world runs. Pure.

Every item of a world file has a name: its own, or its kind and its number among that kind, as in "chair-2".
"""

import math
from collections import Counter
from collections.abc import Mapping

from pydantic import ValidationError

from simulator.furniture.catalogue import FURNITURE
from simulator.scene.parts import Pose2
from simulator.world.items import Item
from simulator.world.world_file import WorldFile

Changes = Mapping[str, Item | None]


class ChangeError(ValueError):
    """A change that the world cannot take; the text goes back to the asker."""


def item_names(world: WorldFile) -> list[str]:
    """Names of all items, in file order."""
    seen: Counter[str] = Counter()
    names = []
    for item in world.furniture:
        seen[item.kind] += 1
        names.append(item.name or f"{item.kind}-{seen[item.kind]}")
    return names


def changed_world(world: WorldFile, changes: Changes) -> WorldFile:
    """The world with items replaced, left out (None), or added after all others."""
    if not changes:
        return world
    names = item_names(world)
    kept = [changes.get(name, item) for name, item in zip(names, world.furniture, strict=True)]
    added = [item for name, item in changes.items() if name not in names]
    furniture = tuple(item for item in [*kept, *added] if item is not None)
    return world.model_copy(update={"furniture": furniture})


def with_item(
    world: WorldFile, changes: Changes, name: str, present: bool | None, pose: Pose2 | None
) -> dict[str, Item | None]:
    """Changes in which an item is gone, back where the file has it, or at a new pose.

    Raises:
        ChangeError: no item has that name, or neither presence nor pose is given.
    """
    known = dict(zip(item_names(world), world.furniture, strict=True))
    item = changes.get(name) or known.get(name)
    if name not in known and name not in changes:
        raise ChangeError(f"{world.name} has no item {name!r}; it has {', '.join([*known, *changes])[:600]}")
    if present is None and pose is None:
        raise ChangeError("needs present (true or false) or a pose, got neither")
    if present is False:
        return {**changes, name: None}
    if pose is not None:
        if item is None:
            raise ChangeError(f"{name!r} was placed and taken away; use place_obstacle")
        return {**changes, name: at_pose(item, pose)}
    if name not in known:
        return {**changes, name: item}
    return {other: change for other, change in changes.items() if other != name}


def with_obstacle(
    world: WorldFile, changes: Changes, name: str | None, kind: str, pose: Pose2
) -> dict[str, Item | None]:
    """Changes with one more item of a catalogue kind, with its default options.

    Raises:
        ChangeError: the kind is unknown or needs options, or the name is taken.
    """
    if kind not in FURNITURE:
        raise ChangeError(f"unknown kind {kind!r}; choose from {', '.join(sorted(FURNITURE))}")
    taken = {*item_names(world), *(other for other, item in changes.items() if item is not None)}
    chosen = name or next(f"obstacle-{k}" for k in range(1, len(taken) + 2) if f"obstacle-{k}" not in taken)
    if chosen in taken:
        raise ChangeError(f"{chosen!r} is there already; use set_item, or another name")
    try:
        item = Item(kind=kind, at_m=pose[:2], yaw_deg=math.degrees(pose[2]))
    except ValidationError as error:
        raise ChangeError(f"{error.errors()[0]['msg']}") from error
    return {**changes, chosen: item}


def at_pose(item: Item, pose: Pose2) -> Item:
    """The item with its origin at a pose on the floor; its height stays."""
    return item.model_copy(update={"at_m": pose[:2], "yaw_deg": math.degrees(pose[2])})
