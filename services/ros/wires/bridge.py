"""Keys and tokens of zenoh-bridge-ros2dds: a key is a ROS name and nothing else. Pure.

The bridge stands beside a robot that speaks DDS. It makes a route where a node of the robot wants what a key
carries, and where a token says that the other side has it; types travel in tokens only.
Source: eclipse-zenoh/zenoh-plugin-ros2dds, src/liveliness_mgt.rs, src/route_service_srv.rs.
"""

from dataclasses import dataclass

from services.ros.wires.wire import Endpoint, Quality

SLASH = "§"
RELIABLE, BEST_EFFORT = 1, 0
"""DDS_RELIABILITY_* of Cyclone DDS, in which the bridge speaks."""
VOLATILE = 0
KEEP_LAST = 0
TOPIC_PARTS, SERVICE_PARTS = 7, 6
"""Of a token: @, session, @ros2_lv, role, key, type, and of topics the qualities."""


@dataclass(frozen=True)
class BridgeNames:
    """Names as a bridge without, or with a namespace has them.

    Attributes:
        session: id of the Zenoh session.
        namespace: of the bridge's configuration, "/" for none.
    """

    session: str
    namespace: str = "/"

    def data_key(self, name: str, kind: str) -> str:  # noqa: ARG002
        """Key of a topic or service."""
        return f"{self.namespace}/{name}".replace("//", "/").strip("/")

    def heard_key(self, name: str, kind: str) -> str:
        """The same."""
        return self.data_key(name, kind)

    def node_token(self) -> str | None:
        """What says that there is a bridge here."""
        return f"@/{self.session}/@ros2_lv"

    def token(self, entity: int, role: str, name: str, kind: str, quality: Quality) -> str:  # noqa: ARG002
        """Token of a publisher (MP), subscriber (MS) or server (SS)."""
        key = self.data_key(name, kind).replace("/", SLASH)
        start = f"@/{self.session}/@ros2_lv/{role}/{key}/{kind.replace('/', SLASH)}"
        if role == "SS":
            return start
        reliability = RELIABLE if quality.reliable else BEST_EFFORT
        return f"{start}/:{reliability}:{VOLATILE}:{KEEP_LAST},{quality.depth}"

    def token_filter(self) -> str:
        """What all tokens match."""
        return "@/*/@ros2_lv/**"

    def read_token(self, key: str) -> tuple[str, str, Endpoint] | None:
        """Role, topic and endpoint of a bridge's token; None of our own, or of what is no endpoint's."""
        parts = key.split("/")
        if len(parts) not in (TOPIC_PARTS, SERVICE_PARTS) or parts[1] == self.session:
            return None
        _, session, _, role, name, kind = parts[:6]
        topic = "/" + name.replace(SLASH, "/")
        if self.namespace != "/":
            topic = topic.removeprefix(self.namespace.rstrip("/"))
        return role, topic, Endpoint(f"bridge {session}", kind.replace(SLASH, "/"))

    def gid(self, token: str) -> bytes:  # noqa: ARG002
        """Not used on this wire."""
        return b""

    def attachment(self, number: int, stamp_ns: int, gid: bytes) -> bytes | None:  # noqa: ARG002
        """None: the bridge reads none of samples."""
        return None

    def answer_attachment(self, request: bytes | None, stamp_ns: int) -> bytes | None:  # noqa: ARG002
        """None: a query and its answer belong together anyway."""
        return None

    answers_need_attachment = False
