"""Bytes made to hurt: always a WireError, within 100 ms and little memory, for every kind of message."""

import contextlib
import gc
import math
import time
from typing import Any

import msgpack
import numpy as np
import pytest
from hypothesis import HealthCheck, example, given, settings
from hypothesis import strategies as st

from shared.messages import all_messages
from shared.messages.base import Message
from shared.messages.maps import MapReply
from shared.topics import QUERIES, TOPICS
from shared.wire import WireError, decode, encode
from tests.contract.paths import arrays, floats, replaced, walk, without
from tests.contract.samples import samples
from tests.traced_memory import TracedCall

LIMIT = 8_000_000
BUDGET_S = 1.0
"""CPU time of one refusal; a decoding bomb takes seconds. A collection of garbage, which takes one beside
thousands of other tests, is no part of it."""
KINDS = [pytest.param(kind, id=kind.SCHEMA) for kind in all_messages()]
RELAXED = settings(max_examples=60, deadline=None, suppress_health_check=list(HealthCheck))
WRONG: tuple[Any, ...] = (
    {"x": 1},
    b"\xff\xfe",
    [[1]],
    -1.5e300,
    msgpack.Timestamp(1),
    msgpack.ExtType(5, b"x"),
)
"""Values of which none fits any field but those that take a map, bytes or any number."""


def content_of(kind: type[Message]) -> dict[str, Any]:
    content = msgpack.unpackb(encode(samples()[kind]))
    assert isinstance(content, dict)
    return content


def refusal_of(kind: type[Message], payload: bytes) -> str:
    """The error of decoding `payload`, which must fail the right way."""
    with pytest.raises(WireError) as caught:
        decode(kind, payload, LIMIT)
    return str(caught.value)


def refuse(kind: type[Message], payload: bytes) -> str:
    """The error of decoding `payload`, which must come in time."""
    gc.disable()
    try:
        started_s = time.thread_time()
        error = refusal_of(kind, payload)
        took_s = time.thread_time() - started_s
    finally:
        gc.enable()
    assert took_s < BUDGET_S
    return error


def decode_or_refuse(kind: type[Message], payload: bytes) -> None:
    """Decode `payload`; what is not a message must be a WireError, nothing else."""
    with contextlib.suppress(WireError):
        assert isinstance(decode(kind, payload, LIMIT), kind)


@pytest.mark.parametrize("kind", KINDS)
def test_every_truncation_is_refused(kind: type[Message]):
    payload = encode(samples()[kind])
    for length in range(len(payload)):
        refuse(kind, payload[:length])


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize(
    "tail", [b"\x00", b"\xc0", b"\xc1", b"junk" * 100], ids=["zero", "nil", "never", "junk"]
)
def test_trailing_bytes_are_refused(kind: type[Message], tail: bytes):
    refuse(kind, encode(samples()[kind]) + tail)


@pytest.mark.parametrize("kind", KINDS)
@RELAXED
@given(payload=st.binary(max_size=200))
@example(payload=b"\xd6\xff\xff\xff\xff\xff")
@example(payload=b"\xc7\x0c\xff" + b"\xff" * 12)
def test_random_bytes_are_refused(kind: type[Message], payload: bytes):
    refuse(kind, payload)


@pytest.mark.parametrize("kind", KINDS)
@RELAXED
@given(data=st.data())
def test_damaged_bytes_raise_nothing_but_wire_errors(kind: type[Message], data: st.DataObject):
    payload = bytearray(encode(samples()[kind]))
    for _ in range(data.draw(st.integers(1, 3))):
        payload[data.draw(st.integers(0, len(payload) - 1))] = data.draw(st.integers(0, 255))
    decode_or_refuse(kind, bytes(payload))


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("opening", [b"\x91", b"\x81\xa1x", b"\xdc\x00\x01"], ids=["lists", "maps", "list16"])
@pytest.mark.parametrize("depth", [500, 5_000, 1_000_000])
def test_deep_nesting_is_refused(kind: type[Message], opening: bytes, depth: int):
    refuse(kind, opening * depth + b"\xc0")


@pytest.mark.parametrize("kind", KINDS)
def test_deep_nesting_inside_any_field_is_refused(kind: type[Message]):
    content = content_of(kind)
    for name in set(content) - {"schema"}:
        deep: Any = None
        for _ in range(200):
            deep = [deep]
        refuse(kind, msgpack.packb(replaced(content, (name,), deep)))


def refuse_huge_lengths(kind: type[Message]) -> None:
    """Array, map, bin, str and ext with 32-bit lengths, alone and as the value of a field."""
    field = next(iter(samples()[kind].model_dump()))
    for opening in (b"\xdd", b"\xdf", b"\xc6", b"\xdb", b"\xc9"):
        header = opening + b"\xff\xff\xff\xff" + (b"\x01" if opening == b"\xc9" else b"")
        refuse(kind, header)
        refuse(kind, b"\x82\xa6schema" + msgpack.packb(kind.SCHEMA) + msgpack.packb(field) + header)


@pytest.mark.parametrize("kind", KINDS)
def test_huge_announced_lengths_are_refused_without_reserving_memory(
    kind: type[Message], traced_call: TracedCall
):
    assert traced_call(refuse_huge_lengths, kind)[1] < 1_000_000


def bomb(filling: bytes, lists: int) -> bytes:
    """Lists of 2,000 times `filling`, as an unknown field would carry them."""
    return b"\xdd" + lists.to_bytes(4, "big") + (b"\xdc\x07\xd0" + filling * 2_000) * lists


@pytest.mark.parametrize(
    "kind", [kind for kind in all_messages() if kind.MAX_ITEMS <= 200_000], ids=lambda kind: kind.SCHEMA
)
@pytest.mark.parametrize(
    "filling", [b"\x80", b"\x90", b"\xa2ab", b"\xc4\x00"], ids=["maps", "lists", "str", "bin"]
)
def test_small_bytes_that_unpack_to_much_are_refused_early(
    kind: type[Message], filling: bytes, traced_call: TracedCall
):
    payload = b"\x82\xa6schema" + msgpack.packb(kind.SCHEMA) + b"\xa1x" + bomb(filling, 1_000)
    error, peak_bytes = traced_call(refusal_of, kind, payload)
    assert "values" in error
    assert peak_bytes < 40_000_000


def test_a_list_of_twenty_thousand_wrong_entries_is_told_in_one_line_and_at_once():
    content = content_of(MapReply) | {"nodes": [None] * 20_000}
    assert refuse(MapReply, msgpack.packb(content)).startswith("map_reply.v1: nodes.0: ")


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("bad", [math.nan, math.inf, -math.inf], ids=str)
def test_nan_and_infinity_are_refused_in_every_number(kind: type[Message], bad: float):
    content = content_of(kind)
    for path in floats(content):
        refuse(kind, msgpack.packb(replaced(content, path, bad)))
    for path in arrays(content):
        array = _at(content, path)
        if not array["dtype"].startswith("float"):
            continue
        values = np.frombuffer(array["data"], array["dtype"]).copy()
        values[-1] = bad
        refuse(kind, msgpack.packb(replaced(content, (*path, "data"), values.tobytes())))


ARRAY_DAMAGE: dict[str, tuple[str, Any]] = {
    "object dtype": ("dtype", "object"),
    "unknown dtype": ("dtype", "float128x"),
    "wider dtype": ("dtype", "complex128"),
    "structured dtype": ("dtype", "f4,f4"),
    "dtype no text": ("dtype", 4),
    "shape no list": ("shape", 4),
    "no axis": ("shape", []),
    "more axes": ("shape", [1] * 40),
    "negative axis": ("shape", [-1, -1]),
    "huge axis": ("shape", [2**63 - 1, 2**63 - 1]),
    "huge product": ("shape", [4096, 4096]),
    "zero hides a huge axis": ("shape", [0, 2**40]),
    "text axis": ("shape", ["2", "2"]),
    "boolean axis": ("shape", [True, True]),
    "fractional axis": ("shape", [2.0, 2.0]),
    "nested axis": ("shape", [[2], [2]]),
    "no data": ("data", b""),
    "one byte less": ("data", b"\0" * 15),
    "text data": ("data", "0" * 16),
    "number data": ("data", 16),
}


@pytest.mark.parametrize(
    "kind", [kind for kind in all_messages() if arrays(content_of(kind))], ids=lambda kind: kind.SCHEMA
)
@pytest.mark.parametrize("damage", ARRAY_DAMAGE)
def test_arrays_of_wrong_dtype_shape_or_size_are_refused(kind: type[Message], damage: str):
    content, (field, value) = content_of(kind), ARRAY_DAMAGE[damage]
    for path in arrays(content):
        refuse(kind, msgpack.packb(replaced(content, (*path, field), value)))
        refuse(kind, msgpack.packb(without(content, (*path, field))))


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize(
    "tag",
    ["", "frame.v0", "x" * 100_000, None, 1, [], {"a": 1}, b"velocity.v1"],
    ids=lambda tag: repr(tag)[:12],
)
def test_another_schema_is_refused(kind: type[Message], tag: Any):
    content = content_of(kind)
    assert len(refuse(kind, msgpack.packb(content | {"schema": tag}))) < 300
    refuse(kind, msgpack.packb(without(content, ("schema",))))


@pytest.mark.parametrize("kind", KINDS)
def test_messages_of_every_other_kind_are_refused(kind: type[Message]):
    for other in all_messages():
        if other is not kind:
            refuse(kind, encode(samples()[other]))


@pytest.mark.parametrize("kind", KINDS)
def test_missing_required_fields_are_refused_by_name(kind: type[Message]):
    content = content_of(kind)
    for name, field in kind.model_fields.items():
        if field.is_required():
            assert name in refuse(kind, msgpack.packb(without(content, (name,))))


@pytest.mark.parametrize("kind", KINDS)
def test_wrong_typed_fields_are_refused(kind: type[Message]):
    content = content_of(kind)
    for path, value in list(walk(content)):
        if not path or path[-1] == "value" or not {"parameters", "checkpoint"}.isdisjoint(path[:-1]):
            continue  # an event's value may be anything simple, what a mission reads any JSON; it checks it
        for wrong in WRONG:
            if _could_fit(wrong, value):
                continue
            refuse(kind, msgpack.packb(replaced(content, path, wrong)))


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("top", [None, True, 0, 1.5, "x", b"x", [], [{}], {}], ids=str)
def test_anything_but_a_message_is_refused(kind: type[Message], top: Any):
    refuse(kind, msgpack.packb(top))


@pytest.mark.parametrize("stream", [*TOPICS, *QUERIES], ids=lambda stream: stream.template)
def test_more_bytes_than_the_stream_allows_are_refused_unread(stream: Any):
    kind = getattr(stream, "message", None) or stream.request
    with pytest.raises(
        WireError, match=f"at most {stream.max_bytes} bytes expected, got {stream.max_bytes + 1}"
    ):
        decode(kind, _Long(stream.max_bytes + 1), stream.max_bytes)  # type: ignore[arg-type]


class _Long(bytes):
    """Bytes that only claim to be long."""

    def __new__(cls, _length: int) -> "_Long":
        return super().__new__(cls)

    def __init__(self, length: int) -> None:
        self._length = length

    def __len__(self) -> int:
        return self._length


def _at(content: Any, path: tuple[Any, ...]) -> Any:
    for key in path:
        content = content[key]
    return content


def _could_fit(wrong: Any, value: Any) -> bool:
    """Whether some field that holds `value` could take `wrong`."""
    numbers = isinstance(value, int | float) and isinstance(wrong, float)
    same = isinstance(wrong, type(value)) or isinstance(value, type(wrong))
    return same or numbers
