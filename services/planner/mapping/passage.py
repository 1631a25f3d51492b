"""Past nodes with somebody else at the wheel: what becomes a node, and which node the robot is at.

The rules are those of a departure (`departure.py`). What differs is that the way is not chosen here: it may
lead on where exploration would turn back, past known nodes, and round a loop. So a node is also made where
the view of the last one fades, whatever else is seen: one that follows another is always joined to it.
"""

from dataclasses import dataclass

from services.planner.mapping.edges import judge_edges
from services.planner.mapping.frontiers.floor_views import FloorViews
from services.planner.mapping.near_nodes import NearNodes
from services.planner.mapping.nodes import add_node, is_new_node
from services.planner.ports import MapAccess, Matcher, Matches, Note, Observation
from services.planner.profiles import Profile
from services.planner.similarity import ranked, similarity
from shared.mapgraph.local.displacement import Displacement

LIKER = 1.25
"""The robot has come to a node when its view resembles that one so much more than the last one; chosen:
halfway between two nodes the views differ by less."""

AT_END_M = 0.1
"""Who stops nearer to a node than this has stopped at it; chosen: `arrival_rad` stands for that."""


@dataclass(frozen=True)
class Reached:
    """The robot is at another node than before.

    Attributes:
        new: whether it was made just now.
    """

    node_id: int
    new: bool
    notes: tuple[Note, ...] = ()


class Passage:
    """From the node of `start` on, until the robot is at another one.

    Attributes:
        nearest, s_best: the node that the last frame resembles most, and by how much; None, 0 without any.
        unseen: whether it showed nothing of the map.
        unseen_frames: frames since one did; those of turning on the spot count less.
    """

    def __init__(
        self, profile: Profile, maps: MapAccess, matcher: Matcher, start: Displacement, views: FloorViews
    ) -> None:
        self._profile, self._maps, self._views = profile, maps, views
        self._near = NearNodes(profile, maps, matcher, start)
        self._last: tuple[Observation, Matches] | None = None
        self._was_unseen = False
        self.nearest: int | None = None
        self.s_best, self.unseen, self.unseen_frames = 0, False, 0.0

    @property
    def here(self) -> Displacement:
        """Where the robot is relative to the node it came from."""
        return self._near.here

    def step(self, observation: Observation) -> Reached | None:
        """One frame; None while the robot is between nodes, or at the one it came from."""
        self._near.moved(observation.moved)
        matches = self._near.seen()
        best = ranked(matches, self._profile)[:1]
        self.nearest = best[0][0] if best else None
        self.s_best = similarity(best[0][1], self._profile) if best else 0
        self.unseen = self.s_best <= self._profile.mapping.s_edge_min
        if self.unseen:
            self._last, self._was_unseen = None, True
            self.unseen_frames += observation.frame_share
            return None
        self._near.locate(matches.get(self.here.node_id))
        self._views.add(self.here, observation.ranges)
        self._last, self.unseen_frames = (observation, matches), 0.0
        if (known := self._come_to(matches)) is not None:
            return Reached(known, new=False)
        if self._is_needed(matches):
            return self._new_node(observation, {**self._near.candidates(), **matches})
        return None

    def stop(self) -> Reached | None:
        """A node where the robot stood in the last frame, unless that was at one or out of sight of any."""
        if self._last is None or self.here.length_m < AT_END_M:
            return None
        observation, matches = self._last
        return self._add(observation, matches)

    def _come_to(self, matches: Matches) -> int | None:
        """A node joined to the last one whose view this is by rule 4.2, rather than the last one's."""
        graph, here = self._maps.graph, self.here.node_id
        s_here = similarity(matches[here], self._profile) if here in matches else 0
        for node, match in ranked(matches, self._profile):
            s_node = similarity(match, self._profile)
            if s_node < self._profile.mapping.s_node_max or s_node <= LIKER * s_here:
                return None
            if node != here and graph.edge(here, node) is not None:
                return node
        return None

    def _is_needed(self, matches: Matches) -> bool:
        """Whether this is a new place, the last node fades, or a corner: views come back that were lost."""
        if is_new_node(matches, self._profile) and not self._near.is_crowded(matches):
            return True
        origin = matches.get(self.here.node_id)
        fades = origin is None or similarity(origin, self._profile) < self._profile.mapping.s_sure
        return fades or (self._was_unseen and is_new_node(matches, self._profile))

    def _new_node(self, observation: Observation, matches: Matches) -> Reached | None:
        """A node here, unless what is sure to be seen makes it a known one."""
        reached = None
        judged = judge_edges(self._maps.graph, observation, matches, self._profile, self.here)
        if self._is_needed(self._near.credible(matches, judged)):
            reached = self._add(observation, matches)
        self._was_unseen = self._was_unseen and reached is None
        return reached

    def _add(self, observation: Observation, matches: Matches) -> Reached | None:
        """Write a node with the edges that it gets; None without any: nothing is sure then."""
        edges = judge_edges(self._maps.graph, observation, matches, self._profile, self.here)
        if not edges.admitted:
            return None
        node_id, refused = add_node(self._maps, observation, edges, self._profile, self.here, self._views)
        joined = self._maps.graph.neighbours(node_id)
        values: dict[str, float | int | str | bool | None] = {
            "node": node_id,
            "edges": len(joined),
            "nearest": self.nearest,
            "s": self.s_best,
        }
        note = Note("node_added", f"new node with {len(joined)} edges", values)
        return Reached(node_id, new=True, notes=(note, *refused))
