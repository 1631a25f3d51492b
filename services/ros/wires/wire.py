"""What the service needs of ROS 2, whichever way the bytes go. All payloads are CDR."""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Protocol

Deliver = Callable[[bytes, float], None]
"""Takes a payload and when it came, monotonic seconds; called on a thread of the wire, so it must be
quick."""

Reply = Callable[[bytes], None]
Answer = Callable[[bytes, Reply], None]
"""Takes a request, and what sends its response, now or later; called on a thread of the wire, so it must be
quick."""

NODE, GUARD_NODE = "topnav", "topnav_guard"
"""Names of our nodes in ROS."""

MOST_BYTES = 64_000_000
"""Longest payload that is taken: the longest frame of the bus (shared/topics.py)."""


class WireError(ConnectionError):
    """The other side cannot be reached, or ended; the text says what to do."""


@dataclass(frozen=True)
class Endpoint:
    """Somebody who publishes or subscribes.

    Attributes:
        node: its name, or what stands for one.
        kind: its type, "geometry_msgs/msg/Twist".
    """

    node: str
    kind: str


@dataclass(frozen=True)
class Quality:
    """Of a publisher or subscriber.

    Attributes:
        reliable: lost messages are sent again. A reliable subscriber hears no best-effort publisher.
        depth: so many messages may wait.
        lives_s: a message that could not be handed on for so long is thrown away.
    """

    reliable: bool = True
    depth: int = 10
    lives_s: float = 5.0


SENSOR = Quality(reliable=False, depth=1)
"""The newest reading of a sensor; the only one that hears every publisher."""
URGENT = Quality(reliable=True, depth=1, lives_s=0.2)
"""Velocities: a reliable publisher is heard by every base. One that was held up longer is worse than none:
the wheels stop without it (chosen, less than a command lives)."""
STANDING_S = 5.0
"""So long a velocity of nothing may be held up: late it does no harm, and the last must arrive; chosen."""
REPORT = Quality(reliable=True, depth=10)


class Put(Protocol):
    """Sends payloads of one publisher."""

    def __call__(self, payload: bytes, lives_s: float | None = None, /) -> None:
        """Send one, never blocking; it may be held up for `lives_s`, None: as its quality says."""


class Wire(Protocol):
    """One node of topnav in a ROS graph. Everything declared ends with `close`."""

    def subscribe(self, topic: str, kind: str, deliver: Deliver, quality: Quality = SENSOR) -> None:
        """Hear a topic ("/scan") of one type from now on."""

    def publisher(self, topic: str, kind: str, quality: Quality = REPORT) -> Put:
        """Declare a publisher; what it returns sends."""

    def serve(self, service: str, kind: str, answer: Answer) -> None:
        """Answer a service ("/topnav/stop") from now on."""

    def publishers(self, topic: str) -> list[Endpoint]:
        """Who else publishes it, of whatever type."""

    def subscribers(self, topic: str) -> list[Endpoint]:
        """Who else subscribes to it, of whatever type."""

    def require_up(self) -> None:
        """Do nothing while the wire works; raise WireError once it does not."""

    def close(self) -> None:
        """Leave the graph, once what was sent before is on its way."""
