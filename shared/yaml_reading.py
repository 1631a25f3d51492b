"""YAML files from outside: bounded in size, depth and references, without doubled keys. Plain data only."""

from dataclasses import dataclass
from pathlib import Path
from typing import Any

import yaml

LOADER = getattr(yaml, "CSafeLoader", yaml.SafeLoader)  # LibYAML's is much faster, where it is built in
MOST_BYTES = 2_000_000
"""Chosen: a hundred times the longest world that comes along."""
MOST_VALUES = 200_000
"""Chosen: read in three seconds; a bomb of references asks for billions (tests/yaml_bomb.py)."""
MOST_DEPTH = 30
"""Chosen: no file of ours is deeper than ten."""


class YamlFileError(ValueError):
    """A file is not YAML that we read; the message says why, without its path."""


@dataclass
class _Open:
    """A list or mapping being read: its anchor and how many values it holds, references counted in full."""

    anchor: str | None
    values: int = 1


def read_yaml(path: Path) -> Any:
    """Read one document of plain data.

    Raises:
        YamlFileError: unreadable, not YAML, too large, too deep, or a key that is there twice.
    """
    try:
        if path.stat().st_size > MOST_BYTES:
            raise YamlFileError(f"must be at most {MOST_BYTES} bytes, got {path.stat().st_size}")
        text = path.read_text(encoding="utf-8")
    except OSError as error:
        raise YamlFileError(f"cannot be read: {error.strerror or error}") from error
    except UnicodeDecodeError as error:
        raise YamlFileError(f"not valid YAML: must be UTF-8 text: {error}") from error
    try:
        _check_extent(text)
        loader = LOADER(text)
        try:
            node = loader.get_single_node()
            if node is None:
                return None
            _check_keys(node)
            return loader.construct_document(node)
        finally:
            loader.dispose()
    except yaml.YAMLError as error:
        raise YamlFileError(f"not valid YAML: {str(error)[:300]}") from error
    except (ArithmeticError, LookupError, TypeError, AttributeError) as error:
        raise YamlFileError(f"not valid YAML: a value cannot be read: {error!s:.200}") from error
    except YamlFileError:
        raise
    except ValueError as error:  # such as the date 2026-99-99
        raise YamlFileError(f"not valid YAML: a value cannot be read: {error!s:.200}") from error


def _check_extent(text: str) -> None:
    """Count values as they will be once references are followed, without following them."""
    sizes: dict[str, int] = {}
    stack: list[_Open] = [_Open(None)]
    for event in yaml.parse(text, Loader=LOADER):
        if isinstance(event, yaml.CollectionStartEvent):
            stack.append(_Open(event.anchor))
        elif isinstance(event, yaml.CollectionEndEvent):
            done = stack.pop()
            stack[-1].values += done.values
            if done.anchor:
                sizes[done.anchor] = done.values
        elif isinstance(event, yaml.ScalarEvent):
            stack[-1].values += 1
        elif isinstance(event, yaml.AliasEvent):
            if any(one.anchor == event.anchor for one in stack):
                raise YamlFileError(f"*{event.anchor} refers to what it is a part of")
            stack[-1].values += sizes.get(event.anchor or "", 1)
        if len(stack) > MOST_DEPTH:
            raise YamlFileError(f"must be nested at most {MOST_DEPTH} deep")
        if stack[-1].values > MOST_VALUES:
            raise YamlFileError(f"must hold at most {MOST_VALUES} values, references counted in full")


def _check_keys(root: yaml.Node) -> None:
    queue, seen = [root], set()
    while queue:
        node = queue.pop()
        if id(node) in seen or isinstance(node, yaml.ScalarNode):
            continue
        seen.add(id(node))
        if isinstance(node, yaml.MappingNode):
            keys: set[str] = set()
            for key, value in node.value:
                if isinstance(key, yaml.ScalarNode) and key.value in keys:
                    line = key.start_mark.line + 1
                    raise YamlFileError(f"line {line}: {key.value[:40]!r} is there twice; keep one of them")
                keys.add(key.value if isinstance(key, yaml.ScalarNode) else "")
                queue += [key, value]
        else:
            queue += node.value
