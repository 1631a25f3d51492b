"""Where a robot is in a map, as one mission leaves it and the next one finds it."""

from dataclasses import dataclass

from shared.mapgraph.local.displacement import Displacement
from shared.messages.features import Features


@dataclass
class Whereabouts:
    """Kept by whoever starts missions, changed by the tracker of the one that runs.

    A robot that waits between two missions stands where it stood. Without this it would ask the map where it
    is, and where rooms look alike a picture does not say: one took the next room for its own and then, a
    room's width off, every other one as well.

    Attributes:
        map: of which it tells.
        here: where the robot is relative to a node; None while nobody knows.
        guessed: it was found at one of several places that look alike, and followed from there.
        now, before: the frame that says so, and the one before it.
    """

    map: str = ""
    here: Displacement | None = None
    guessed: bool = False
    now: Features | None = None
    before: Features | None = None

    def of(self, name: str) -> "Whereabouts":
        """This, where the next mission is in the same map; else nobody knows anything."""
        return self if name == self.map else Whereabouts(name)
