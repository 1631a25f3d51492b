"""Whether a robot is where it believes to be, by views that are compared with the whole map. Pure.

Reach keeps a robot from jumping to look-alikes, and as surely at one where it believes to be by mistake: in a
hostel whose two sides mirror each other one drove 110 m of a mission turned round by half a turn.
"""

LOOK_AROUND_M = 1.5
"""Way between two views that are compared with the whole map; chosen: two nodes further on."""
DOUBTS = 3
"""So many of them in a row that show other places refute a belief. Of 184 views on ways through a hotel and a
hostel of development, a third of the furniture moved, none showed other places than the right one alone
(tests/benchmarks/test_views_on_the_way.py)."""


class Doubts:
    """Counts the views in a row that speak against where a robot believes to be."""

    def __init__(self) -> None:
        self._in_a_row, self._since_m = 0, 0.0

    @property
    def are_due(self) -> bool:
        """Whether the next view should be compared with the whole map."""
        return self._since_m >= LOOK_AROUND_M

    def went(self, way_m: float) -> None:
        """The robot went on."""
        self._since_m += way_m

    def settle(self) -> None:
        """It is known where the robot is, by this view or by what it did."""
        self._in_a_row, self._since_m = 0, 0.0

    def refute(self) -> bool:
        """This view shows other places alone: whether once too often; from beside the last one it is not."""
        if self._in_a_row and not self.are_due:
            return False
        self._in_a_row, self._since_m = self._in_a_row + 1, 0.0
        return self._in_a_row >= DOUBTS
