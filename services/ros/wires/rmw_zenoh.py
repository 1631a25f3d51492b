"""Keys, tokens and attachments of rmw_zenoh: what its nodes say to each other through a Zenoh router. Pure.

Source: ros2/rmw_zenoh, docs/design.md, and
rmw_zenoh_cpp/src/detail/{liveliness_utils,attachment_helpers}.cpp.
"""

import struct
from dataclasses import dataclass

import xxhash

from services.ros.wires.codec import Codec, dds_name, ros_name
from services.ros.wires.wire import Endpoint, Quality

ADMIN_SPACE = "@ros2_lv"
TOKEN_PARTS = 13
"""Of an endpoint's token: space, domain, session, node, entity, kind, enclave, namespace, name, topic, type,
hash, qualities."""
ATTACHMENT = struct.Struct("<qqB16s")
"""Sequence number from 1, nanoseconds since the epoch, length of what follows, gid."""
BEST_EFFORT = "2"
"""RMW_QOS_POLICY_RELIABILITY_BEST_EFFORT; reliable is the default and left out, as all defaults are."""
DEFAULT_DEPTH = 42
"""Of rmw_zenoh's default profile (rmw_zenoh_cpp/src/detail/qos.cpp)."""
GID_BYTES = 16


@dataclass(frozen=True)
class RmwZenohNames:
    """Names of one node in one domain.

    Attributes:
        codec: knows the type hashes, without which a key is heard by nobody.
        domain: ROS_DOMAIN_ID.
        node: name of the node.
        session: id of the Zenoh session, as Zenoh writes it.
    """

    codec: Codec
    domain: int
    node: str
    session: str

    def data_key(self, name: str, kind: str) -> str:
        """Key of a topic that is published, or of a service."""
        return f"{self.domain}/{name.strip('/')}/{dds_name(kind)}/{self.codec.type_hash(kind)}"

    def heard_key(self, name: str, kind: str) -> str:
        """Key of a topic that is subscribed to: whatever hash its publisher has."""
        return f"{self.domain}/{name.strip('/')}/{dds_name(kind)}/*"

    def node_token(self) -> str | None:
        """Token of the node."""
        return f"{ADMIN_SPACE}/{self.domain}/{self.session}/0/0/NN/%/%/{self.node}"

    def token(self, entity: int, role: str, name: str, kind: str, quality: Quality) -> str:
        """Token of a publisher (MP), subscriber (MS) or server (SS): what `ros2 topic list` reads."""
        reliability = "" if quality.reliable else BEST_EFFORT
        depth = "" if quality.depth == DEFAULT_DEPTH else quality.depth
        return (
            f"{ADMIN_SPACE}/{self.domain}/{self.session}/0/{entity}/{role}/%/%/{self.node}/"
            f"{name.replace('/', '%')}/{dds_name(kind)}/{self.codec.type_hash(kind)}/"
            f"{reliability}::,{depth}:,:,:,,"
        )

    def token_filter(self) -> str:
        """What all tokens of the domain match."""
        return f"{ADMIN_SPACE}/{self.domain}/**"

    def read_token(self, key: str) -> tuple[str, str, Endpoint] | None:
        """Role, topic and endpoint of a token of somebody else; None of a node's, our own, or no token."""
        parts = key.split("/")
        if len(parts) != TOKEN_PARTS or parts[2] == self.session:
            return None
        role, namespace, node, topic, kind = parts[5], parts[7], parts[8], parts[9], parts[10]
        full = f"{namespace.replace('%', '/').rstrip('/')}/{node}"
        return role, topic.replace("%", "/"), Endpoint(full, ros_name(kind))

    def gid(self, token: str) -> bytes:
        """Global id of the endpoint with this token: its XXH3, low half first, each little-endian."""
        return xxhash.xxh3_128_intdigest(token.encode()).to_bytes(GID_BYTES, "little")

    def attachment(self, number: int, stamp_ns: int, gid: bytes) -> bytes | None:
        """What goes with every sample and answer: one without it is dropped."""
        return ATTACHMENT.pack(number, stamp_ns, GID_BYTES, gid)

    def answer_attachment(self, request: bytes | None, stamp_ns: int) -> bytes | None:
        """What goes with an answer: number and gid of the request; None if that had none that can be read."""
        if request is None or len(request) != ATTACHMENT.size:
            return None
        number, _, length, gid = ATTACHMENT.unpack(request)
        return ATTACHMENT.pack(number, stamp_ns, length, gid) if length == GID_BYTES else None

    answers_need_attachment = True
