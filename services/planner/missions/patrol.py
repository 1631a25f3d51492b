"""Mission patrol: drive from place to place, in rounds, and say which were missed."""

from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import partial

from pydantic import BaseModel, ConfigDict, Field

from services.planner.goals.nodes import node_called
from services.planner.mission_kinds import MissionContext, MissionError, MissionKind
from services.planner.missions.goto import goto_place
from services.planner.ports import Decision, Mission, Note, Observation, Progress
from shared.messages.missions import FailureKind
from shared.messages.places import PlaceName

TOLD = 8
"""Missed places that the reason names; chosen: the text stays a line."""


class PatrolParameters(BaseModel):
    """Which places, how often."""

    model_config = ConfigDict(frozen=True, extra="forbid")

    places: tuple[PlaceName, ...] = Field(
        min_length=1, max_length=64, description="Names of places, in the order of the round."
    )
    rounds: int = Field(default=1, ge=0, le=100_000, description="0: until it is cancelled.")
    dwell_s: float = Field(default=0.0, ge=0.0, le=600.0, description="Stay at each place so long.")


class Missed(BaseModel):
    """A place that was not reached, in the order of visits."""

    model_config = ConfigDict(frozen=True, extra="forbid")

    visit: int = Field(ge=0)
    place: PlaceName
    failure: FailureKind


class Checkpoint(BaseModel):
    """What a planner that restarts goes on from.

    Attributes:
        visit: the one under way, counted over all rounds.
        missed: the first ones that failed; a patrol without an end keeps no more than are told.
        missed_in_all: how many.
    """

    model_config = ConfigDict(frozen=True, extra="forbid")

    visit: int = Field(default=0, ge=0)
    missed: tuple[Missed, ...] = ()
    missed_in_all: int = Field(default=0, ge=0)


@dataclass(frozen=True)
class _Stay:
    """At a place until a moment, by the clock of the frames."""

    until_ns: int
    place: str


class Patrol:
    """Visits places one after the other; one that cannot be reached is left out and told at the end.

    Args:
        parameters: which places, how often.
        travel_to: a mission that drives to a place; MissionError where there is none of that name any more.
        begun: where an earlier planner left off.
        look: what is done at the end of each stay, with the place and the round from 1; what it tells.
    """

    def __init__(
        self,
        parameters: PatrolParameters,
        travel_to: Callable[[str], Mission],
        begun: Checkpoint | None = None,
        look: Callable[[str, int], Note] | None = None,
    ) -> None:
        self._parameters, self._travel_to, self._look = parameters, travel_to, look
        self._at = Checkpoint() if begun is None else begun
        self._leg: Mission | None = None
        self._stay: _Stay | None = None

    @property
    def progress(self) -> Progress:
        """Where it stands."""
        leg = Progress() if self._leg is None else self._leg.progress
        figures: dict[str, float | int | str | bool | None] = {
            "round": self._round,
            "place": self._place,
            "visited": self._at.visit - self._at.missed_in_all,
            "missed": self._at.missed_in_all,
        }
        return replace(leg, figures=figures, checkpoint=self._at.model_dump(mode="json"))

    def decide(self, observation: Observation) -> Decision:
        """One frame: on the way to a place, staying there, or setting out for the next."""
        if self._stay is not None:
            if observation.features.stamp_ns < self._stay.until_ns:
                return Decision("hold", why=f"staying at {self._stay.place}")
            if (told := self._leave()) is not None:
                return told
        if self._is_over():
            return self._end()
        if self._leg is None:
            try:
                self._leg = self._travel_to(self._place)
            except MissionError as error:
                return self._miss(error.failure, str(error))
        decision = self._leg.decide(observation)
        if decision.outcome == "succeeded":
            return self._arrive(observation, decision)
        if decision.outcome == "failed":
            return self._miss(decision.failure, decision.why, decision.notes)
        return decision

    @property
    def _place(self) -> str:
        places = self._parameters.places
        return places[self._at.visit % len(places)]

    @property
    def _round(self) -> int:
        return self._at.visit // len(self._parameters.places) + 1

    def _is_over(self) -> bool:
        rounds = self._parameters.rounds
        return rounds > 0 and self._at.visit >= rounds * len(self._parameters.places)

    def _arrive(self, observation: Observation, decision: Decision) -> Decision:
        place, visit = self._place, self._at.visit
        stay_ns = round(1e9 * self._parameters.dwell_s)
        note = Note("visited", f"{place}: {decision.why}", {"place": place, "visit": visit})
        self._leg = None
        if stay_ns or self._look is not None:
            self._stay = _Stay(observation.features.stamp_ns + stay_ns, place)
        else:
            self._next()
        return self._hold(decision.why, (*decision.notes, note))

    def _leave(self) -> Decision | None:
        """The end of a stay: look round first; the stay goes on where that cannot be done now."""
        assert self._stay is not None
        note = self._look(self._stay.place, self._round) if self._look is not None else None
        self._stay = None
        self._next()
        return None if note is None else self._hold(note.reason, (note,))

    def _miss(self, failure: FailureKind, why: str, notes: tuple[Note, ...] = ()) -> Decision:
        missed = Missed(visit=self._at.visit, place=self._place, failure=failure)
        note = Note("missed", f"{missed.place}: {why}", {"place": missed.place, "visit": missed.visit})
        told = (*self._at.missed, missed)[:TOLD]
        self._leg = None
        self._at = Checkpoint(visit=self._at.visit + 1, missed=told, missed_in_all=self._at.missed_in_all + 1)
        return self._hold(f"{missed.place} is left out: {why}", (*notes, note))

    def _next(self) -> None:
        self._at = self._at.model_copy(update={"visit": self._at.visit + 1})

    def _hold(self, why: str, notes: tuple[Note, ...]) -> Decision:
        """A frame of standing between two legs; the last one where nothing is left to visit."""
        if self._stay is None and self._is_over():
            return replace(self._end(), notes=notes)
        return Decision("hold", why=why, notes=notes)

    def _end(self) -> Decision:
        visits, missed = self._at.visit, self._at.missed
        if not missed:
            return Decision("hold", why=f"all {visits} visits made", outcome="succeeded")
        names = ", ".join(f"{one.place} ({one.failure})" for one in missed)
        untold = self._at.missed_in_all - len(missed)
        more = f" and {untold} more" if untold else ""
        why = f"{visits - self._at.missed_in_all} of {visits} visits made, missed: {names}{more}"
        return Decision("hold", why=why, outcome="failed", failure=missed[0].failure)


def _make(context: MissionContext, parameters: PatrolParameters) -> Patrol:
    if not context.checkpoint:  # one that has begun leaves out what is gone or forbidden by now
        for name in parameters.places:
            node_called(context.maps, name)
    begun = Checkpoint.model_validate(context.checkpoint)
    return Patrol(parameters, partial(goto_place, context), begun)


KIND = MissionKind(
    name="patrol",
    title="Patrol places",
    parameters=PatrolParameters,
    make=_make,
    shown=("round", "place", "visited", "missed"),
)
