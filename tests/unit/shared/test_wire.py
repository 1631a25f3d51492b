"""The codec: what an error tells, and that reading stays cheap."""

import msgpack
import pytest

from shared.messages.drive import Command, Heading
from shared.wire import WireError, decode, encode


def test_bytes_carry_the_tag_first():
    assert encode(Command(robot="r1")).startswith(b"\x8a\xa6schema\xaacommand.v1")


def test_errors_name_schema_field_and_rule():
    payload = msgpack.packb({"schema": "command.v1", "robot": "R1", "ttl_ms": 0})
    with pytest.raises(
        WireError, match=r"^command\.v1: robot: String should match pattern .* \(and 1 more\)$"
    ):
        decode(Command, payload, 10_000)


def test_errors_of_another_schema_name_both():
    with pytest.raises(WireError, match=r"schema 'heading\.v1' expected, got 'command\.v1'"):
        decode(Heading, encode(Command(robot="r1")), 10_000)


def test_length_is_checked_before_anything_is_read():
    with pytest.raises(WireError, match="at most 10 bytes expected, got 1000"):
        decode(Command, b"\xc1" * 1000, 10)
