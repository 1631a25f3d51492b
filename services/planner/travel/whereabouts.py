"""Where a robot is in a map, as one mission leaves it and the next one finds it."""

from dataclasses import dataclass, field

from services.planner.look_alikes import LookAlikes
from shared.mapgraph.local.displacement import Displacement
from shared.messages.features import Features
from shared.motion.motion import NO_MOTION, Motion

APART_M = 0.05
"""Between two frames that are to say how much views of one spot share; chosen: as far as a robot stops from
where a picture was taken. Where it stands still two frames are one picture, and share more than any other."""


@dataclass(frozen=True)
class Rival:
    """Where else the robot may be, and how likely that is, as a multiple of that by which it goes."""

    here: Displacement
    odds: float = 1.0


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
        rivals: the others of these places, followed as well.
        now, before: the frame that says so, and the one before it.
        apart: the latest of the frames that the robot left `APART_M` behind, and somewhat more.
        look_alikes: how often rooms of the map look alike in everything, as the missions in it found out.
    """

    map: str = ""
    here: Displacement | None = None
    guessed: bool = False
    rivals: list[Rival] = field(default_factory=list)
    now: Features | None = None
    before: Features | None = None
    apart: Features | None = None
    look_alikes: LookAlikes = field(default_factory=LookAlikes)
    _left: Features | None = field(default=None, init=False)
    _since: Motion = field(default=NO_MOTION, init=False)

    def observe(self, features: Features, moved: Motion) -> None:
        """A frame, and how the robot moved since the one before; none is the one before itself."""
        if self.now is not None and (self.now.seq, self.now.stamp_ns) == (features.seq, features.stamp_ns):
            return
        self.before, self.now = self.now, features
        self._since = self._since.then(moved)
        if self._left is None or self._since.way_m >= APART_M:
            self.apart, self._left, self._since = self._left, features, NO_MOTION

    def of(self, name: str) -> "Whereabouts":
        """This, where the next mission is in the same map; else nobody knows anything."""
        return self if name == self.map else Whereabouts(name)
