"""Which topic a recorded key belongs to, and what else the file says about it."""

import json
import re
from typing import Any

from shared.messages.base import Message
from shared.topics import TOPICS, Topic

MESSAGE_ENCODING = "msgpack"
SCHEMA_ENCODING = "jsonschema"


class RecordingError(ValueError):
    """A recording that cannot be read or written; the text says what to do."""


def name_of(topic: Topic[Message]) -> str:
    """Short name of a topic: "frame", "velocity", "delta"."""
    return topic.template.rpartition("/")[2]


def topics_named(names: str) -> set[str]:
    """Split "frame,truth" and check every name.

    Raises:
        RecordingError: no topic has that name.
    """
    asked = {name.strip() for name in names.split(",") if name.strip()}
    known = {name_of(topic) for topic in TOPICS}
    if asked - known:
        raise RecordingError(
            f"a topic must be one of {', '.join(sorted(known))}, got {', '.join(sorted(asked - known))}"
        )
    return asked


def topic_of(key: str) -> tuple[Topic[Message], dict[str, str]] | None:
    """The topic of a key and the names in it, {"robot": "r1"}; None for a key of somebody else."""
    for topic in TOPICS:
        pattern = re.sub(r"\{(\w+)\}", r"(?P<\1>[a-z0-9_-]{1,64})", topic.template)
        found = re.fullmatch(pattern, key)
        if found is not None:
            return topic, found.groupdict()
    return None


def json_schema(topic: Topic[Message]) -> bytes:
    """JSON Schema of the topic's message, for programs that do not have this project."""
    schema: dict[str, Any] = topic.message.model_json_schema()
    return json.dumps(schema, sort_keys=True).encode()
