"""The one codec: pydantic message <-> msgpack bytes."""

from collections.abc import Callable, Sized
from typing import TypeVar

import msgpack
from pydantic import ValidationError

from shared.messages.base import Message

M = TypeVar("M", bound=Message)
Container = TypeVar("Container", bound=Sized)

MAX_CONTAINER = 20_000
"""Largest list on the wire; big data travels as binary."""

MAX_FIELDS = 256
"""Largest map on the wire: maps are messages, and a newer version may have more fields."""


class WireError(ValueError):
    """Bytes that are not the expected message; the text says what was expected and what came."""


def encode(message: Message) -> bytes:
    """Pack a message with its schema tag."""
    packed = msgpack.packb({"schema": message.SCHEMA, **message.model_dump()}, use_bin_type=True)
    assert isinstance(packed, bytes)
    return packed


def decode(kind: type[M], payload: bytes, max_bytes: int) -> M:
    """Unpack and validate one message.

    Raises:
        WireError: too long, not msgpack, another schema, or a field that does not validate.
    """
    if len(payload) > max_bytes:
        raise WireError(f"{kind.SCHEMA}: at most {max_bytes} bytes expected, got {len(payload)}")
    count = _item_counter(kind.MAX_ITEMS)
    try:
        content = msgpack.unpackb(
            payload,
            raw=False,
            strict_map_key=True,
            max_array_len=min(MAX_CONTAINER, kind.MAX_ITEMS, len(payload)),
            max_map_len=MAX_FIELDS,
            list_hook=count,
            object_hook=count,
        )
    except (ValueError, TypeError, RecursionError, msgpack.UnpackException) as error:
        raise WireError(f"{kind.SCHEMA}: not msgpack: {type(error).__name__}: {str(error)[:120]}") from error
    if not isinstance(content, dict):
        raise WireError(f"{kind.SCHEMA}: a map expected, got {type(content).__name__}")
    if content.get("schema") != kind.SCHEMA:
        raise WireError(f"schema {kind.SCHEMA!r} expected, got {str(content.get('schema'))[:64]!r}")
    try:
        return kind.model_validate(content)
    except (ValidationError, RecursionError) as error:
        raise WireError(f"{kind.SCHEMA}: {_first_problem(error)}") from error


def _item_counter(most: int) -> Callable[[Container], Container]:
    """A hook for every finished list and map that refuses more than `most` values in all."""
    seen = 0

    def count(container: Container) -> Container:
        nonlocal seen
        seen += 1 + len(container)
        if seen > most:
            raise ValueError(f"more than {most} values")
        return container

    return count


def _first_problem(error: Exception) -> str:
    if not isinstance(error, ValidationError):
        return "nested too deeply"
    problems = error.errors(include_url=False, include_input=False)
    place = ".".join(str(part) for part in problems[0]["loc"]) or "message"
    more = f" (and {len(problems) - 1} more)" if len(problems) > 1 else ""
    return f"{place}: {problems[0]['msg']}{more}"
