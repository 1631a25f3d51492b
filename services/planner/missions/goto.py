"""Mission goto: drive to where a picture was taken (thesis sections 4.1 and 4.3)."""

from dataclasses import replace
from functools import partial

from pydantic import BaseModel, ConfigDict, Field

from services.planner.goals.destination import GoalDestination
from services.planner.goals.nodes import check_allowed, node_called, node_reading
from services.planner.mission_kinds import MissionContext, MissionError, MissionKind
from services.planner.photographs.photo_goto import PhotoGoto
from services.planner.ports import Decision, MapAccess, Matcher, Mission, Observation, Progress
from services.planner.profiles import Profile
from services.planner.travel.edge_experience import EdgeExperience
from services.planner.travel.machine import Travel
from services.planner.travel.states import State
from services.planner.travel.whereabouts import Whereabouts
from shared.messages.features import Features
from shared.messages.places import PlaceName


class GotoParameters(BaseModel):
    """Goal of a goto without a picture: one of them."""

    model_config = ConfigDict(frozen=True, extra="forbid")

    goal_node: int | None = Field(default=None, ge=0, lt=2**63, description="A node of the map.")
    place: PlaceName | None = Field(default=None, description="The name of a place.")
    sign: PlaceName | None = Field(default=None, description="What a sign says, such as a room number.")


class Goto:
    """Travels to a goal picture; ends with arrival or a typed failure.

    Args:
        profile: thresholds.
        maps: the map.
        matcher: compares frames.
        goal: the picture.
        whereabouts: as the mission before left them.
        node: of the map, whose picture it is; None where nobody knows.
    """

    def __init__(
        self,
        profile: Profile,
        maps: MapAccess,
        matcher: Matcher,
        goal: Features,
        whereabouts: Whereabouts | None = None,
        node: int | None = None,
    ) -> None:
        self._profile, self._maps, self._matcher, self._goal = profile, maps, matcher, goal
        self._whereabouts, self._node = whereabouts or Whereabouts(), node
        self._travel: Travel | None = None

    @property
    def progress(self) -> Progress:
        """Where it stands."""
        return Progress() if self._travel is None else self._travel.progress

    def decide(self, observation: Observation) -> Decision:
        """One frame; in the first one the goal is located in the map."""
        if self._travel is not None:
            return self._outcome(self._travel, self._travel.step(observation))
        experience = EdgeExperience(self._profile, self._maps)
        destination = GoalDestination(
            self._profile,
            self._maps,
            self._matcher,
            self._goal,
            experience,
            self._whereabouts,
            self._node,
        )
        self._travel = Travel(
            self._profile, self._maps, self._matcher, destination, experience, self._whereabouts
        )
        located = destination.located()
        decision = self._travel.step(observation)
        return self._outcome(self._travel, replace(decision, notes=(located, *decision.notes)))

    @staticmethod
    def _outcome(travel: Travel, decision: Decision) -> Decision:
        return replace(decision, outcome="succeeded") if travel.state is State.ARRIVED else decision


def goto_place(context: MissionContext, name: str) -> Goto:
    """To the place of a name; MissionError where there is none that the rules allow."""
    return _goto_node(context, node_called(context.maps, name))


def _goto_node(context: MissionContext, node_id: int) -> Goto:
    goal = context.maps.features_of(node_id)
    return Goto(context.profile, context.maps, context.matcher, goal, context.whereabouts, node_id)


def _make(context: MissionContext, parameters: GotoParameters) -> Mission:
    node_id, place, sign = parameters.goal_node, parameters.place, parameters.sign
    if sum(given is not None for given in (context.goal, node_id, place, sign)) != 1:
        raise MissionError(
            "goto needs a goal picture's features, a goal_node, a place or a sign, exactly one of them"
        )
    if place is not None:
        node_id = node_called(context.maps, place)
    if sign is not None:
        node_id = node_reading(context.maps, sign)
    profile, maps, matcher, goal = context.profile, context.maps, context.matcher, context.goal
    if node_id is not None:
        if node_id not in maps.graph.nodes:
            raise MissionError(f"the map has no node {node_id}", "missing")
        check_allowed(maps, node_id)
        return _goto_node(context, node_id)
    assert goal is not None
    if goal.photo is None:
        return Goto(profile, maps, matcher, goal, context.whereabouts)
    return PhotoGoto(profile, maps, matcher, goal, goal.photo, partial(_goto_node, context), context.rng)


KIND = MissionKind(
    name="goto",
    title="Drive to a picture, node, place or sign",
    parameters=GotoParameters,
    make=_make,
    shown=("similarity",),
    takes_picture=True,
)
