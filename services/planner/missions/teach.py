"""Mission teach: a person drives, the robot maps as it goes, and may keep the way as a route.

It never moves the base: it goes along with the hand of a person until it is told to finish. A node is made
only where the map shows; where the person drove on too fast, the robot says so and waits to see a node again,
for a node that is joined to nothing would be of no use, and one joined by guess is a false edge.
"""

from dataclasses import replace

from pydantic import BaseModel, ConfigDict, Field

from services.planner.mapping.edges import NewEdges
from services.planner.mapping.frontiers.floor_views import FloorViews
from services.planner.mapping.nodes import add_node
from services.planner.mapping.passage import Passage, Reached
from services.planner.mission_kinds import MissionContext, MissionError, MissionKind
from services.planner.ports import Decision, Note, Observation, Progress
from services.planner.routes.trail import Trail
from services.planner.similarity import ranked, similarity
from services.planner.travel.edge_experience import EdgeExperience
from services.planner.travel.tracking import Tracker
from shared.mapgraph.graph import edge_key
from shared.mapgraph.local.displacement import Displacement
from shared.messages.places import PlaceName, PutRoute, Route, key_of

COMPARED = 8
"""Nodes compared to find out where the robot is; as many as a goto compares."""


class TeachParameters(BaseModel):
    """Whether the way is kept."""

    model_config = ConfigDict(frozen=True, extra="forbid")

    route: PlaceName | None = Field(default=None, description="Keep the way as a route of this name.")


class Checkpoint(BaseModel):
    """What a planner that restarts goes on from.

    Attributes:
        passed: nodes, in order.
    """

    model_config = ConfigDict(frozen=True, extra="forbid")

    passed: tuple[int, ...] = ()


class Teach:
    """Goes along, and remembers the nodes passed."""

    def __init__(self, context: MissionContext, route: str | None) -> None:
        self._profile, self._maps, self._matcher = context.profile, context.maps, context.matcher
        self._route = route
        self._tracker = Tracker(
            context.profile, context.maps, context.matcher, certain=True, whereabouts=context.whereabouts
        )
        self._experience = EdgeExperience(context.profile, context.maps)
        self._views = FloorViews(context.profile.sensing.robot_slim_m)
        begun = Checkpoint.model_validate(context.checkpoint)
        self._trail = Trail(context.maps.graph, begun.passed)
        self._passage: Passage | None = None
        self._progress = Progress()

    @property
    def progress(self) -> Progress:
        """Where it stands; the nodes passed are its path."""
        passed = self._trail.nodes
        checkpoint = Checkpoint(passed=passed).model_dump(mode="json")
        return replace(
            self._progress,
            via_points=passed,
            via_index=max(0, len(passed) - 1),
            figures={"passed": len(passed)},
            checkpoint=checkpoint,
        )

    def decide(self, observation: Observation) -> Decision:
        """One frame: map, or find out where the robot is. It holds: a person drives."""
        self._tracker.observe(observation)
        if not self._maps.graph.nodes:
            return self._first(observation)
        if self._passage is None:
            return self._localise()
        return self._go_along(observation, self._passage)

    def finish(self) -> str:
        """End where the robot stands, and keep the route; what was taught."""
        reached = None if self._passage is None else self._passage.stop()
        if reached is not None:
            self._reach(reached)
        graph = self._maps.graph
        passed = Trail(graph, self._trail.nodes).nodes  # somebody may have taken an edge of it away
        told = f"taught: the map has {len(graph.nodes)} nodes and {len(graph.edges)} edges"
        if self._route is None:
            return told
        if len(passed) < 2:
            why = f"route {self._route!r} would have {len(passed)} nodes: drive on, or cancel"
            raise MissionError(why, "conflict")
        self._maps.commit([PutRoute(route=Route(name=self._route, nodes=passed))])
        return f"{told}; route {self._route!r} leads along {len(passed)} nodes"

    def _first(self, observation: Observation) -> Decision:
        node_id, _ = add_node(self._maps, observation, NewEdges(), self._profile, None, self._views)
        note = Note("node_added", "first node of the map", {"node": node_id})
        return self._reach(Reached(node_id, new=True, notes=(note,)))

    def _localise(self) -> Decision:
        """Nothing is added before the view is that of a node by rule 4.2: from there on edges are driven."""
        matches = self._matcher.match(self._tracker.nearby(), COMPARED)
        seen = self._tracker.possible(matches)
        self._tracker.confirm(seen)
        best = ranked(seen, self._profile)[:1]
        s_best = similarity(best[0][1], self._profile) if best else 0
        self._progress = Progress(nearest_node=best[0][0] if best else None, similarity=s_best)
        if self._tracker.here is None or not best or s_best < self._profile.mapping.s_node_max:
            where = f"node {best[0][0]} is near, S {s_best}: drive to it" if best else "no node is recognised"
            return Decision("hold", why=f"{where}; nothing is taught before the robot is at a node it knows")
        node_id = best[0][0]
        here = self._tracker.standing_at(node_id, matches)
        note = Note("localised", f"at node {node_id}, S {s_best}", {"node": node_id, "s": s_best})
        return self._reach(Reached(node_id, new=False, notes=(note,)), here)

    def _go_along(self, observation: Observation, passage: Passage) -> Decision:
        was_unseen = passage.unseen
        reached = passage.step(observation)
        self._progress = Progress(nearest_node=passage.nearest, similarity=passage.s_best)
        self._tracker.stand_at(passage.here)
        if reached is not None:
            return self._reach(reached)
        if not passage.unseen:
            why = f"going along from node {passage.here.node_id}, S {passage.s_best}"
            return Decision("hold", why=why)
        return self._unseen(passage, news=not was_unseen)

    def _unseen(self, passage: Passage, *, news: bool) -> Decision:
        """The person drove on too fast, or round a corner: say so, and reckon for a few frames."""
        node_id = passage.here.node_id
        carried = self._tracker.was_carried()
        if carried or passage.unseen_frames > self._profile.mapping.saturation_steps:
            self._passage = None
            if carried:
                self._tracker.stand_at(None)
            what = "this is another place than a moment ago" if carried else "out of sight for too long"
            why = f"{what}: node {node_id} is lost; drive to a node of the map"
            return Decision("hold", why=why, notes=(Note("view_lost", why, {"node": node_id}),))
        why = f"node {node_id} is out of sight, S {passage.s_best}: drive back until it shows, then slower"
        notes = (Note("view_fades", why, {"node": node_id}),) if news else ()
        return Decision("hold", why=why, notes=notes)

    def _reach(self, reached: Reached, here: Displacement | None = None) -> Decision:
        """The robot is at a node: the next passage begins there."""
        node_id, graph = reached.node_id, self._maps.graph
        before = self._trail.nodes[-1] if self._trail.nodes else None
        notes = list(reached.notes)
        if here is None and reached.new:
            here = Displacement(node_id)
        if here is None:
            matches = self._matcher.match([node_id, *self._tracker.nearby()], 0)
            here = self._tracker.standing_at(node_id, matches)
            if before is not None and graph.edge(before, node_id) is not None:
                driven = self._experience.driven(edge_key(before, node_id), matches.get(node_id))
                notes += [] if driven is None else [driven]
        if between := self._trail.reach(graph, node_id):
            why = f"the way from node {before} was not seen: by the map it leads along {list(between)}"
            notes.append(Note("way_filled", why))
        self._tracker.stand_at(here)
        self._progress = replace(self._progress, nearest_node=node_id)
        self._passage = Passage(self._profile, self._maps, self._matcher, here, self._views)
        what = "new" if reached.new else "known"
        return Decision("hold", why=f"at node {node_id}, {what}", notes=tuple(notes))


def _make(context: MissionContext, parameters: TeachParameters) -> Teach:
    route = parameters.route
    if route is not None and not context.checkpoint and key_of(route) in context.maps.graph.routes:
        why = f"the map has a route {route!r} already: remove it, or choose another name"
        raise MissionError(why, "conflict")
    return Teach(context, route)


KIND = MissionKind(
    name="teach",
    title="Teach by driving",
    parameters=TeachParameters,
    make=_make,
    shown=("nodes", "edges", "passed"),
    makes_map=True,
    by_hand=True,
)
