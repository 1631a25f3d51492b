"""Furniture of a world file: single items, and groups of them that are placed more than once."""

import math
from collections.abc import Mapping, Sequence
from typing import Any, Self

from pydantic import (
    Field,
    ValidationError,
    ValidationInfo,
    field_serializer,
    field_validator,
    model_validator,
)

from simulator.furniture.catalogue import FURNITURE
from simulator.world.fields import MOST_M, Degrees, FileModel, Metres, Name, Seed

MOST_ITEMS = 3000  # of a world, copies of groups included


class Item(FileModel):
    """A piece of furniture: kind, position, heading of its front, height, seed, and options of that kind.

    Items with a `name` can be removed or moved while the world runs.
    """

    name: Name | None = None
    kind: str
    at_m: tuple[Metres, Metres]
    yaw_deg: Degrees = 0.0
    z_m: Metres = 0.0
    seed: Seed = 0
    options: dict[str, Any] = Field(default_factory=dict)

    @field_validator("options")
    @classmethod
    def _files_opened(cls, options: dict[str, Any], info: ValidationInfo) -> dict[str, Any]:
        kind = FURNITURE.get(info.data.get("kind", ""))
        return kind.opened(options, info.context) if kind else options

    @field_serializer("options", when_used="json")
    def _files_by_content(self, options: dict[str, Any]) -> dict[str, Any]:
        return {
            name: {key: getattr(one, "digest", one) for key, one in value.items()}
            if isinstance(value, dict)
            else getattr(value, "digest", value)
            for name, value in options.items()
        }

    @model_validator(mode="after")
    def _known(self) -> Self:
        if self.kind not in FURNITURE:
            raise ValueError(
                f"unknown furniture kind {self.kind!r}; choose from {', '.join(sorted(FURNITURE))}"
            )
        FURNITURE[self.kind].check(self.options)
        return self


class Placement(FileModel):
    """A copy of a group: where its origin lies, how far it is turned, and what is different in it.

    Attributes:
        name: put before the names of its items ("room 3 bed"); without it they have none.
        changed: by the name of an item within the group, keys in place of its own (options one by one);
            None leaves that item out.
    """

    group: Name
    at_m: tuple[Metres, Metres]
    yaw_deg: Degrees = 0.0
    name: Name | None = None
    changed: dict[Name, dict[str, Any] | None] = Field(default_factory=dict, max_length=MOST_ITEMS)


def placed_items(
    groups: Mapping[str, tuple[Item, ...]], placements: Sequence[Placement], context: object
) -> list[Item]:
    """The items of all copies, in the world's frame.

    Args:
        groups: items by the name of their group, in its frame.
        placements: the copies.
        context: where files named by changed options are found, see Kind.opened.

    Raises:
        ValueError: a placement does not fit; the message begins with its place in the file.
    """
    for k, placement in enumerate(placements):
        if placement.group not in groups:
            known = ", ".join(groups)[:200] or "none"
            raise ValueError(f"placed.{k}: unknown group {placement.group!r}; groups are {known}")
    count = sum(len(groups[placement.group]) for placement in placements)
    if count > MOST_ITEMS:
        raise ValueError(f"placed: a world has at most {MOST_ITEMS} pieces of furniture, got {count}")
    items: list[Item] = []
    for k, placement in enumerate(placements):
        try:
            own = _changed(groups[placement.group], placement, context)
            items.extend(_moved(item, placement) for item in own)
        except ValidationError as error:
            faults = "; ".join(f"{'.'.join(map(str, e['loc']))} {e['msg']}"[:400] for e in error.errors()[:3])
            raise ValueError(f"placed.{k}.changed: {faults}") from error
        except ValueError as error:
            raise ValueError(f"placed.{k}: {error}") from error
    return items


def _changed(group: tuple[Item, ...], placement: Placement, context: object) -> list[Item]:
    """The items of a group, still in its frame, with the changes of one copy."""
    names = {item.name for item in group if item.name}
    unknown = sorted(set(placement.changed) - names)
    if unknown:
        raise ValueError(
            f"changed: group {placement.group!r} has no item named {', '.join(unknown)[:200]}; "
            f"it has {', '.join(sorted(names))[:200] or 'no named item'}"
        )
    items = []
    for item in group:
        change = placement.changed.get(item.name, {}) if item.name else {}
        if change is None:
            continue
        items.append(_with(item, change, context) if change else item)
    return items


def _with(item: Item, change: dict[str, Any], context: object) -> Item:
    fields = {name: getattr(item, name) for name in Item.model_fields} | change
    if isinstance(change.get("options"), dict):
        fields["options"] = item.options | change["options"]
    return Item.model_validate(fields, context=context)


def _moved(item: Item, placement: Placement) -> Item:
    """An item of a group where this copy has it."""
    yaw_rad = math.radians(placement.yaw_deg)
    c, s = math.cos(yaw_rad), math.sin(yaw_rad)
    x_m = placement.at_m[0] + c * item.at_m[0] - s * item.at_m[1]
    y_m = placement.at_m[1] + s * item.at_m[0] + c * item.at_m[1]
    if max(abs(x_m), abs(y_m)) > MOST_M:
        raise ValueError(f"coordinates must lie within +-{MOST_M:g} m, {item.kind} is at ({x_m:g}, {y_m:g})")
    # Without rounding, copies turned by right angles would differ from one another in their last bits.
    at_m = (round(x_m, 9), round(y_m, 9))
    name = f"{placement.name} {item.name}" if placement.name and item.name else None
    return item.model_copy(update={"at_m": at_m, "yaw_deg": item.yaw_deg + placement.yaw_deg, "name": name})
