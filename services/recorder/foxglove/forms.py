"""A message of the bus in the forms that Foxglove reads: as JSON, and as what its panels draw.

The export of a recording and the live view share it: what one shows, the other shows.
"""

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from functools import cache, partial
from typing import TYPE_CHECKING

from services.recorder.channels import SCHEMA_ENCODING, RecordingError, topic_of
from services.recorder.foxglove.plain_json import plain_json, plain_schema
from shared.messages.base import Message
from shared.wire import WireError, decode

if TYPE_CHECKING:
    from services.recorder.foxglove.drawings import Draw, FoxgloveMessage


@dataclass(frozen=True)
class FormSchema:
    """What all messages of one channel are.

    Attributes:
        name: of the schema, as "foxglove.CompressedImage" or "ranges.v1".
        encoding: of the definition, as "protobuf" or "jsonschema"; definition: in it.
        message_encoding: of the messages, as "protobuf" or "json".
    """

    name: str
    encoding: str
    definition: bytes
    message_encoding: str


@dataclass(frozen=True)
class Form:
    """One message in one form.

    Attributes:
        channel: "topnav/r1/frame" for its numbers, "topnav/r1/frame/image" for a drawing of it.
        schema: asked only for a channel's first message.
        data: the message.
    """

    channel: str
    schema: Callable[[], FormSchema]
    data: bytes


def message_of(key: str, payload: bytes) -> Message:
    """Decode what came under a key.

    Raises:
        WireError: no topic of this version, or not its message.
    """
    found = topic_of(key)
    if found is None:
        raise WireError("no topic of this version")
    topic, _ = found
    return decode(topic.message, payload, topic.max_bytes)


def as_json(key: str, message: Message) -> Form:
    """All numbers and words of a message, for plots."""
    return Form(key, partial(_json_schema, type(message)), plain_json(message))


def as_drawings(key: str, message: Message, arrived_ns: int, draws: "Sequence[Draw]") -> Iterator[Form]:
    """What Foxglove draws of a message, each in a channel below its key.

    Args:
        key: that it came under.
        message: any of the bus.
        arrived_ns: when, on this machine's clock.
        draws: each gives the drawings of the messages it knows.

    Raises:
        NotDrawableError: it has no picture in Foxglove.
    """
    for draw in draws:
        for one in draw(message, arrived_ns):
            yield Form(f"{key}/{one.part}", partial(schema_of, one.message), one.message.encode())


def schema_of(message: "FoxgloveMessage") -> FormSchema:
    """The schema of a class of the foxglove-sdk, whose messages are encoded like it."""
    schema = message.get_schema()
    return FormSchema(schema.name, schema.encoding, schema.data, schema.encoding)


def load_drawings() -> "Draw":
    """The drawings, imported only here: nothing else of the recorder needs the extra.

    Raises:
        RecordingError: the foxglove-sdk is missing.
    """
    try:
        from services.recorder.foxglove.drawings import draw
    except ImportError as error:
        raise RecordingError(
            f"Foxglove needs one more package here: pip install 'topnav[foxglove]' ({error})"
        ) from error
    return draw


@cache
def _json_schema(kind: type[Message]) -> FormSchema:
    return FormSchema(kind.SCHEMA, SCHEMA_ENCODING, plain_schema(kind), "json")
