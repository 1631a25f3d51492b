"""Mission home: drive to the place of that name, wherever people put it."""

from services.planner.mission_kinds import MissionContext, MissionError, MissionKind, NoParameters
from services.planner.missions.goto import Goto, goto_place
from shared.messages.places import key_of

HOME = "home"


def _make(context: MissionContext, _parameters: NoParameters) -> Goto:
    if key_of(HOME) not in context.maps.graph.places:
        raise MissionError(
            f"the map has no place {HOME!r}: give its node that name ('topnav place name {HOME} NODE')",
            "missing",
        )
    return goto_place(context, HOME)


KIND = MissionKind(
    name="home", title="Drive home", parameters=NoParameters, make=_make, shown=("similarity",)
)
