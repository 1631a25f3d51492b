"""Whether a robot is where it believes to be, by views that are compared with the whole map. Pure.

Reach keeps a robot from jumping to look-alikes, and as surely at one where it believes to be by mistake: in a
hostel whose two sides mirror each other one drove 110 m of a mission turned round by half a turn.
"""

from shared.motion.motion import NO_MOTION, Motion

LOOK_AROUND_M = 1.5
"""Way between two views that are compared with the whole map, and distance between spots that count as two;
chosen: two nodes further on. In a shop whose shelves had been moved a corner looked like another one, from
wherever a robot stood that tried to get out of it."""
DOUBTS = 3
"""So many spots that show other places, and none between them that shows the right one, refute a belief. Of
247 views on ways through a hotel and a hostel of development, a third of the furniture moved, and a yard none
showed other places alone (tests/benchmarks/test_views_on_the_way.py)."""


class Doubts:
    """Counts the spots in a row whose views speak against where a robot believes to be."""

    def __init__(self) -> None:
        self._since_m, self._spots = 0.0, list[Motion]()

    @property
    def are_due(self) -> bool:
        """Whether the next view should be compared with the whole map."""
        return self._since_m >= LOOK_AROUND_M

    def went(self, moved: Motion) -> None:
        """The robot went on."""
        self._since_m += moved.way_m
        self._spots = [since.then(moved) for since in self._spots]

    def settle(self) -> None:
        """It is known where the robot is, by this view or by what it did."""
        self._since_m, self._spots = 0.0, []

    def refute(self) -> bool:
        """This view shows other places alone: whether so do enough views, each from another spot."""
        self._since_m = 0.0
        if all(since.way_m >= LOOK_AROUND_M for since in self._spots):
            self._spots.append(NO_MOTION)
        return len(self._spots) >= DOUBTS
