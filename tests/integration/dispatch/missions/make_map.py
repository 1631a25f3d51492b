"""A mission that is over at once and makes its map where that is missing."""

from services.planner.mission_kinds import MissionContext, MissionKind, NoParameters
from services.planner.ports import Decision, Observation, Progress


class MakeMap:
    """Done in its first frame."""

    progress = Progress()

    def decide(self, _observation: Observation) -> Decision:
        """Be done."""
        return Decision("hold", why="the map is there", outcome="succeeded")


def _make(_context: MissionContext, _parameters: NoParameters) -> MakeMap:
    return MakeMap()


KIND = MissionKind("make_map", "Make a map", NoParameters, _make, makes_map=True)
