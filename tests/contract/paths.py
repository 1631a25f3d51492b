"""Finding and replacing values inside decoded messages, so that tests can damage one place at a time."""

import copy
from collections.abc import Callable, Iterator
from typing import Any

Path = tuple[str | int, ...]


def walk(content: Any, path: Path = ()) -> Iterator[tuple[Path, Any]]:
    """Every value with its path, containers included."""
    yield path, content
    children = (
        content.items() if isinstance(content, dict) else enumerate(content) if _is_list(content) else ()
    )
    for key, value in children:
        yield from walk(value, (*path, key))


def replaced(content: Any, path: Path, value: Any) -> Any:
    """A copy of `content` with another value at `path`."""
    return changed(content, path, lambda owner, key: owner.__setitem__(key, value))


def without(content: Any, path: Path) -> Any:
    """A copy of `content` that lacks the value at `path`."""
    return changed(content, path, lambda owner, key: owner.__delitem__(key))


def changed(content: Any, path: Path, change: Callable[[Any, Any], None]) -> Any:
    """A copy of `content` after `change(owner, key)` of the value at `path`."""
    twin = copy.deepcopy(content)
    owner = twin
    for key in path[:-1]:
        owner = owner[key]
    change(owner, path[-1])
    return twin


def arrays(content: Any) -> list[Path]:
    """Paths of all arrays."""
    return [path for path, value in walk(content) if isinstance(value, dict) and "dtype" in value]


def floats(content: Any) -> list[Path]:
    """Paths of all floating point numbers outside arrays."""
    return [path for path, value in walk(content) if isinstance(value, float)]


def _is_list(content: Any) -> bool:
    return isinstance(content, list | tuple)
