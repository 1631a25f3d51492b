"""CDR bytes, type hashes and wire names of ROS 2 types, from the definitions that come with rosbags. Pure.

XCDR1, as every ROS 2 middleware sends it: a header of four bytes, alignment counted after it. Padding bytes
are arbitrary: compare values, never bytes.
"""

from dataclasses import is_dataclass
from typing import Any, Literal

import numpy as np
from rosbags.interfaces import Nodetype
from rosbags.serde import SerdeError
from rosbags.typesys import Stores, get_types_from_msg, get_typestore

Distribution = Literal["humble", "jazzy", "kilted"]
"""ROS 2 releases whose definitions differ in nothing that topnav uses, but Humble has no type hashes."""

NO_HASH = "TypeHashNotSupported"
"""What stands in Humble's keys in place of a hash (rmw_zenoh, docs/design.md)."""

EVENT_INFO = "service_msgs/msg/ServiceEventInfo"
SERVICES = {
    "std_srvs/srv/Trigger": ("", "bool success\nstring message"),
}
"""Request and response of the services that topnav offers, as std_srvs defines them; rosbags has messages
only."""

EVENT_INFO_TEXT = """uint8 event_type
builtin_interfaces/Time stamp
uint8[16] client_gid
int64 sequence_number"""
"""As ROS hashes it: its char is a uint8, which rosbags 0.11.9 hashes as another type; Humble's has none."""


class CodecError(ValueError):
    """Bytes that are no message of the type that was expected; the text says which."""


class Codec:
    """Encodes and decodes the messages of one ROS 2 release."""

    def __init__(self, distribution: Distribution) -> None:
        self._store = get_typestore(Stores(f"ros2_{distribution}"))
        self._hashed = distribution != "humble"
        self._store.fielddefs.pop(EVENT_INFO, None)
        self._store.register(get_types_from_msg(EVENT_INFO_TEXT, EVENT_INFO))
        for service in SERVICES:
            self._define(service)

    def make(self, kind: str, **fields: Any) -> Any:
        """A message of type `kind` ("sensor_msgs/msg/LaserScan"); nested ones are made the same way.

        Fields that are left out are zero or empty.
        """
        cls = self._store.types[kind]
        _, definition = self._store.fielddefs[kind]
        values = {name: fields.pop(name, None) for name, _ in definition}
        if fields:
            raise TypeError(f"{kind} has no field {', '.join(fields)}")
        zeros = {name: self._zero(description) for name, description in definition if values[name] is None}
        return cls(**{**values, **zeros})

    def encode(self, kind: str, message: Any) -> bytes:
        """CDR, little-endian."""
        return bytes(self._store.serialize_cdr(message, kind, little_endian=True))

    def decode(self, kind: str, payload: bytes) -> Any:
        """The message in `payload`.

        Raises:
            CodecError: too short, too long, or a text or length in it makes no sense.
        """
        try:
            message = self._store.deserialize_cdr(payload, kind)
        except (SerdeError, IndexError, AssertionError, MemoryError, OverflowError, TypeError) as error:
            reason = str(error)[:120] or type(error).__name__
            raise CodecError(f"{kind} expected, {len(payload)} bytes are none: {reason}") from error
        assert is_dataclass(message)
        return message

    def type_hash(self, kind: str) -> str:
        """Hash of a message or service definition (REP 2016), as it stands in rmw_zenoh's keys."""
        return self._store.hash_rihs01(kind) if self._hashed else NO_HASH

    def _define(self, service: str) -> None:
        """Add a service: its two messages, the event that pairs them, and all together, for the hash."""
        request, response, event = (f"{service}_{part}" for part in ("Request", "Response", "Event"))
        definitions: dict[str, Any] = {}
        for name, text in zip((request, response), SERVICES[service], strict=True):
            (parsed,) = get_types_from_msg(text, "topnav/msg/Part").values()
            definitions[name] = parsed
        one_at_most = {part: (Nodetype.SEQUENCE, ((Nodetype.NAME, part), 1)) for part in (request, response)}
        definitions[event] = (
            [],
            [
                ("info", (Nodetype.NAME, EVENT_INFO)),
                ("request", one_at_most[request]),
                ("response", one_at_most[response]),
            ],
        )
        parts = (("request_message", request), ("response_message", response), ("event_message", event))
        definitions[service] = ([], [(name, (Nodetype.NAME, kind)) for name, kind in parts])
        self._store.register(definitions)

    def _zero(self, description: Any) -> Any:
        node, rest = description
        if node == Nodetype.NAME:
            return self.make(rest)
        if node == Nodetype.BASE:
            return "" if rest[0] == "string" else False if rest[0] == "bool" else 0
        (inner, name), length = rest
        length = length if node == Nodetype.ARRAY else 0
        if inner == Nodetype.BASE and name[0] != "string":
            return np.zeros(length, dtype=_NUMPY.get(name[0], name[0]))
        return [self._zero((inner, name)) for _ in range(length)]


_NUMPY = {"byte": "uint8", "char": "uint8", "bool": "bool"}


def dds_name(kind: str) -> str:
    """Name of a type as DDS has it: "std_msgs/msg/String" is "std_msgs::msg::dds_::String_"."""
    package, folder, name = kind.split("/")
    return f"{package}::{folder}::dds_::{name}_"


def ros_name(dds: str) -> str:
    """The reverse; a name of another form comes back as it is."""
    parts = dds.split("::")
    if len(parts) != 4 or parts[2] != "dds_":
        return dds
    return f"{parts[0]}/{parts[1]}/{parts[3].removesuffix('_')}"
