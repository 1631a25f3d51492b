"""The codec: what an error tells, and that reading stays cheap."""

import msgpack
import pytest

from shared.messages.drive import Heading, Velocity
from shared.wire import WireError, decode, encode


def test_bytes_carry_the_tag_first():
    assert encode(Velocity(robot="r1")).startswith(b"\x8c\xa6schema\xabvelocity.v1")


def test_errors_name_schema_field_and_rule():
    payload = msgpack.packb({"schema": "velocity.v1", "robot": "R1", "ttl_ms": 0})
    with pytest.raises(
        WireError, match=r"^velocity\.v1: robot: String should match pattern .* \(and 1 more\)$"
    ):
        decode(Velocity, payload, 10_000)


def test_errors_of_another_schema_name_both():
    with pytest.raises(WireError, match=r"schema 'heading\.v1' expected, got 'velocity\.v1'"):
        decode(Heading, encode(Velocity(robot="r1")), 10_000)


def test_length_is_checked_before_anything_is_read():
    with pytest.raises(WireError, match="at most 10 bytes expected, got 1000"):
        decode(Velocity, b"\xc1" * 1000, 10)
