"""Mission inspect: a patrol that takes a picture at each place and tells what changed since the last one."""

from dataclasses import replace
from functools import partial
from typing import Self

from pydantic import Field, model_validator

from services.planner.goals.nodes import node_called
from services.planner.mission_kinds import MissionContext, MissionError, MissionKind
from services.planner.missions.goto import goto_place
from services.planner.missions.patrol import Checkpoint, Patrol, PatrolParameters
from services.planner.ports import Decision, Inspector, Note, Observation, Progress
from shared.messages.places import key_of

KEPT = 10
"""Pictures of a place that stay, if nobody says otherwise; chosen: a working week, morning and evening."""


class InspectParameters(PatrolParameters):
    """Which places, how often, and how many pictures stay."""

    dwell_s: float = Field(
        default=1.0, ge=0.0, le=600.0, description="Stand at each place so long before the picture is taken."
    )
    keep: int = Field(default=KEPT, ge=2, le=1000, description="Newest pictures of each place that stay.")

    @model_validator(mode="after")
    def _each_once(self) -> Self:
        if len({key_of(place) for place in self.places}) < len(self.places):
            raise ValueError("a round inspects each place once: name each once")
        return self


class Inspected(Checkpoint):
    """What a planner that restarts goes on from.

    Attributes:
        changes: regions reported so far.
        compared: visits that could be compared with one before.
    """

    changes: int = Field(default=0, ge=0)
    compared: int = Field(default=0, ge=0)


class Inspect:
    """A patrol with a look at each place.

    Args:
        parameters: which places, how often, how many pictures stay.
        context: of the mission.
        inspector: looks.
    """

    def __init__(self, parameters: InspectParameters, context: MissionContext, inspector: Inspector) -> None:
        begun = Inspected.model_validate(context.checkpoint)
        self._keep, self._inspector = parameters.keep, inspector
        self._changes, self._compared = begun.changes, begun.compared
        self._patrol = Patrol(parameters, partial(goto_place, context), begun, self._look)

    @property
    def progress(self) -> Progress:
        """Where the patrol stands, and what it found."""
        found = {"changes": self._changes, "compared": self._compared}
        patrol = self._patrol.progress
        return replace(patrol, figures={**patrol.figures, **found}, checkpoint={**patrol.checkpoint, **found})

    def decide(self, observation: Observation) -> Decision:
        """As the patrol does."""
        return self._patrol.decide(observation)

    def _look(self, place: str, round_number: int) -> Note:
        visit = self._inspector.inspect(place, round_number, self._keep)
        compared = visit.against_ns is not None
        self._changes += len(visit.regions)
        self._compared += compared
        found = f"{len(visit.regions)} changes" if compared else f"not compared: {visit.why}"
        values: dict[str, float | int | str | bool | None] = {
            "place": place,
            "round": round_number,
            "changes": len(visit.regions),
            "compared": compared,
        }
        return Note("inspected", f"{place}: {found}", values)


def _make(context: MissionContext, parameters: InspectParameters) -> Inspect:
    if context.inspector is None:
        raise MissionError("inspect needs somebody who looks at pictures; this planner has nobody")
    if not context.checkpoint:  # one that has begun leaves out what is gone or forbidden by now
        for name in parameters.places:
            node_called(context.maps, name)
    return Inspect(parameters, context, context.inspector)


KIND = MissionKind(
    name="inspect",
    title="Inspect places",
    parameters=InspectParameters,
    make=_make,
    shown=("round", "place", "visited", "missed", "compared", "changes"),
)
