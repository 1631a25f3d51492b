"""The one codec: pydantic message <-> msgpack bytes."""

from typing import TypeVar

import msgpack
from pydantic import ValidationError

from shared.messages.base import Message

M = TypeVar("M", bound=Message)

MAX_CONTAINER = 20_000
"""Largest list or map on the wire; big data travels as binary."""


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
    try:
        content = msgpack.unpackb(
            payload, raw=False, strict_map_key=True, max_array_len=MAX_CONTAINER, max_map_len=MAX_CONTAINER
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


def _first_problem(error: Exception) -> str:
    if not isinstance(error, ValidationError):
        return "nested too deeply"
    problems = error.errors(include_url=False, include_input=False)
    place = ".".join(str(part) for part in problems[0]["loc"]) or "message"
    more = f" (and {len(problems) - 1} more)" if len(problems) > 1 else ""
    return f"{place}: {problems[0]['msg']}{more}"
