"""Damaging what bytes mean: one value of a tree of lists and maps replaced, removed, doubled or nested."""

import copy
import math
from random import Random
from typing import Any

LEAVES: tuple[Any, ...] = (
    None, True, False, 0, 1, -1, 255, 2**31, 2**53 + 1, 2**63 - 1, -(2**63), 0.0, -0.0, 1e-308, 1e308,
    math.nan, math.inf, -math.inf, "", "a", "A", "../../etc/passwd", "a\n", "\0", "é\U0001f600", "*",
    "x" * 5000, "1e999", "2026-99-99", b"", b"\0", b"\xff" * 4096, [], {}, [[]], {"": None}, [0] * 3000,
)  # fmt: skip
DEEPEST = 400
LARGEST = 20_000
"""Values of a tree that is damaged further."""


def random_tree(random: Random, depth: int = 4) -> Any:
    """Any tree."""
    kind = random.randrange(4) if depth else 0
    if kind == 2:
        return [random_tree(random, depth - 1) for _ in range(random.randrange(4))]
    if kind == 3:
        return {_key(random): random_tree(random, depth - 1) for _ in range(random.randrange(4))}
    return copy.deepcopy(random.choice(LEAVES))


def damaged_tree(random: Random, tree: Any) -> Any:
    """A copy with one to three places damaged."""
    twin = copy.deepcopy(tree)
    for _ in range(random.choice((1, 1, 1, 2, 3))):
        places = _places(twin)
        if not places:
            return random_tree(random)
        if len(places) > LARGEST:
            break
        owner, key = random.choice(places)
        _damage(random, owner, key, places)
    return twin


def _damage(random: Random, owner: Any, key: Any, places: list[tuple[Any, Any]]) -> None:
    kind = random.randrange(8)
    if kind == 0:
        del owner[key]
    elif kind == 1:
        other, name = random.choice(places)
        owner[key] = copy.deepcopy(other[name])
    elif kind == 2 and isinstance(owner, list):
        owner[key:key] = [copy.deepcopy(owner[key])] * random.choice((1, 2, 50, _fitting(owner[key])))
    elif kind == 3 and isinstance(owner, dict):
        owner[_key(random)] = owner.pop(key)
    elif kind == 4:
        owner[key] = _nested(random, owner[key])
    elif kind == 5 and isinstance(owner[key], int | float) and not isinstance(owner[key], bool):
        owner[key] = _other_number(random, owner[key])
    else:
        owner[key] = random_tree(random, 2)


def _places(tree: Any) -> list[tuple[Any, Any]]:
    """(owner, key) of every value below the root."""
    found: list[tuple[Any, Any]] = []
    stack = [tree]
    while stack:
        owner = stack.pop()
        keys: Any = owner if isinstance(owner, dict) else range(len(owner)) if isinstance(owner, list) else ()
        for key in keys:
            found.append((owner, key))
            stack.append(owner[key])
    return found


def _fitting(value: Any) -> int:
    return max(1, 3000 // (1 + len(_places(value))))


def _nested(random: Random, value: Any) -> Any:
    for _ in range(random.choice((1, 3, 40, DEEPEST))):
        value = [value] if random.random() < 0.5 else {_key(random): value}
    return value


def _other_number(random: Random, value: float) -> Any:
    return random.choice((-value, value + 1, value * 1e6, value / 1e6, float(value), str(value)))


def _key(random: Random) -> str:
    return random.choice(("", "a", "schema", "name", "data", "shape", "dtype", "kind", "x" * 300, "\0"))
