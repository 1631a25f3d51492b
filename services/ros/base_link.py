"""What the base hears: velocities of the type that it subscribes to, and why it hears nothing."""

from collections.abc import Sequence
from typing import Protocol

from services.ros.conversions.twist import Motion, twist_bytes
from services.ros.wires.codec import Codec
from services.ros.wires.wire import STANDING_S, URGENT, Endpoint, Put, Wire


class Spoken(Protocol):
    """A velocity topic of the robot's file: `VelocityTopic` or `Guard`."""

    @property
    def topic(self) -> str:
        """Its name."""

    @property
    def frame(self) -> str:
        """frame_id of a stamped message."""

    def types(self) -> tuple[str, ...]:
        """Types that may be sent, the better one first."""


class BaseLink:
    """Speaks to whoever subscribes to a velocity topic.

    ROS matches publishers and subscribers by type: a Twist for a base that wants TwistStamped is heard by
    nobody, and nobody says so. So the type is read from the subscriber first.
    """

    def __init__(self, wire: Wire, codec: Codec, spoken: Spoken) -> None:
        self._wire, self._codec, self._spoken = wire, codec, spoken
        self._put: dict[str, Put] = {}

    def problem(self) -> str:
        """Why nothing can be sent now; "" if it can."""
        return chosen_type(self._spoken, self._wire.subscribers(self._spoken.topic))[1]

    def send(self, motion: Motion, robot_time_s: float | None) -> None:
        """Send one velocity, if anybody can hear it."""
        kind, _ = chosen_type(self._spoken, self._wire.subscribers(self._spoken.topic))
        if kind is None:
            return
        if kind not in self._put:
            self._put[kind] = self._wire.publisher(self._spoken.topic, kind, URGENT)
        payload = twist_bytes(self._codec, kind, motion, self._spoken.frame, robot_time_s)
        self._put[kind](payload, STANDING_S if motion.stands else None)


def chosen_type(spoken: Spoken, there: Sequence[Endpoint]) -> tuple[str | None, str]:
    """The type to send, None for none, and what is wrong, "" for nothing."""
    allowed = spoken.types()
    if not there:
        nobody = f"{spoken.topic}: nobody subscribes to it: is the driver of the base up?"
        return (allowed[0] if len(allowed) == 1 else None), nobody
    wanted = {endpoint.kind for endpoint in there}
    for kind in allowed:
        if kind in wanted:
            return kind, ""
    heard = ", ".join(sorted(f"{endpoint.node} as {endpoint.kind}" for endpoint in there))
    return None, f"{spoken.topic}: {' or '.join(allowed)} expected, but it is subscribed to by {heard}"[:400]
