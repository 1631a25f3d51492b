"""Every message survives the wire unchanged, and bytes that were sent once are understood for ever."""

import msgpack
import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from shared.messages import all_messages
from shared.messages.base import Message
from shared.messages.features import Features
from shared.messages.sensors import Frame
from shared.wire import WireError, decode, encode
from tests.contract.samples import GOLDEN, golden_files, samples
from tests.contract.strategies import messages

LIMIT = 1_000_000
KINDS = [pytest.param(kind, id=kind.SCHEMA) for kind in all_messages()]


@pytest.mark.parametrize("kind", KINDS)
@settings(max_examples=25, deadline=None, suppress_health_check=list(HealthCheck))
@given(data=st.data())
def test_round_trip_keeps_every_field(kind: type[Message], data: st.DataObject):
    message = data.draw(messages(kind))
    back = decode(kind, encode(message), LIMIT)
    assert back.model_dump() == message.model_dump()


@pytest.mark.parametrize("kind", KINDS)
def test_bytes_that_were_sent_once_are_understood(kind: type[Message]):
    for path in golden_files(kind):
        assert isinstance(decode(kind, path.read_bytes(), LIMIT), kind)


@pytest.mark.parametrize("kind", KINDS)
def test_newest_golden_bytes_decode_and_encode_to_the_same_bytes(kind: type[Message]):
    """After adding a field with a default: fill it in in samples.py and run that as a module."""
    golden = golden_files(kind)[-1].read_bytes()
    message = decode(kind, golden, LIMIT)
    assert encode(message) == golden
    assert message.model_dump() == samples()[kind].model_dump()


def test_every_golden_file_belongs_to_a_message():
    assert set(GOLDEN.iterdir()) == {path for kind in all_messages() for path in golden_files(kind)}


@pytest.mark.parametrize("kind", KINDS)
def test_samples_fill_in_every_field_with_something_else_than_its_default(kind: type[Message]):
    message = samples()[kind]
    for name, field in kind.model_fields.items():
        value = getattr(message, name)
        if not field.is_required() and not isinstance(value, np.ndarray | Message | tuple):
            assert value != field.default, name


@pytest.mark.parametrize("kind", KINDS)
def test_unknown_fields_of_newer_versions_are_ignored(kind: type[Message]):
    content = msgpack.unpackb(encode(samples()[kind]))
    content["added_in_2030"] = {"a": [1, 2.5, "x"]}
    assert encode(decode(kind, msgpack.packb(content), LIMIT)) == encode(samples()[kind])


def test_schema_tags_are_unique_and_versioned():
    tags = [kind.SCHEMA for kind in all_messages()]
    assert len(set(tags)) == len(tags)
    assert all(tag.rsplit(".v", 1)[1].isdigit() for tag in tags)


def test_decoded_arrays_cannot_be_written_to():
    features = decode(Features, encode(samples()[Features]), LIMIT)
    with pytest.raises(ValueError, match="read-only"):
        features.scores[0] = 1.0


def test_frames_from_before_there_was_gravity_have_none():
    oldest, *_, newest = golden_files(Frame)
    assert decode(Frame, oldest.read_bytes(), LIMIT).gravity is None
    assert decode(Frame, newest.read_bytes(), LIMIT).gravity == (0.6, 0.0, -0.8)


@pytest.mark.parametrize(
    ("gravity", "says"),
    [
        ((0.0, 0.0, -9.81), "gravity: Value error, gravity must be a unit vector, got length 9.81"),
        ((0.0, 0.0, 0.0), "must be a unit vector, got length 0"),
        ((0.0, 0.0, -1.002), "must be a unit vector, got length 1.002"),
        ((0.0, 0.0, float("nan")), "gravity.2: Input should be a finite number"),
        ((0.0, -1.0), "gravity.2: Field required"),
        ("down", "gravity: Input should be a valid tuple"),
    ],
)
def test_gravity_that_is_no_unit_vector_is_refused(gravity, says):
    content = msgpack.unpackb(encode(samples()[Frame])) | {"gravity": gravity}
    with pytest.raises(WireError, match=f"^frame.v1: .*{says}"):
        decode(Frame, msgpack.packb(content), LIMIT)
    nearly = content | {"gravity": (0.0, 0.0, -0.9991)}
    assert decode(Frame, msgpack.packb(nearly), LIMIT).gravity == (0.0, 0.0, -0.9991)
