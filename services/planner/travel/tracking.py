"""Where the robot is while it travels: the last node it surely saw, and what it did since.

A robot does not jump. What a frame claims of nodes that lie elsewhere is perceptual aliasing, however alike
they look. Only a robot that was carried is elsewhere: then this frame does not resemble the one before it, or
the robot has looked in vain for long. Or it never was where it believed to be: then views from here and there
show other places (`doubts`).
"""

import logging
import math

from services.planner.echoes import is_elsewhere
from services.planner.mapping.reach import distances, in_reach, nodes_nearby
from services.planner.ports import MapAccess, Matcher, Matches, Observation
from services.planner.profiles import Profile
from services.planner.similarity import similarity
from services.planner.travel.doubts import Doubts
from services.planner.travel.following.waypoints import is_at
from services.planner.travel.rivals import Rivals
from services.planner.travel.sights import Sights
from services.planner.travel.whereabouts import Whereabouts
from shared.mapgraph.local.displacement import Displacement
from shared.mapgraph.local.view_range import openness
from shared.mapgraph.routing import GOAL
from shared.messages.features import Features
from shared.messages.matching import NodeMatch
from shared.messages.sensors import Ranges

PATIENCE_FRAMES = 40
"""Frames that show nothing within reach after which the robot must have been carried, however smoothly;
chosen: 5 m of search, twice the way on which it can have gone astray by itself."""

BEYOND_M, BEYOND_STDS = 0.6, 2.0
"""Who is further than this from a node in a room, and so many standard deviations of where the robot is, is
not there; chosen: half as far again as `travel_arrival_rad` stands for."""

AT_NODE_M = 0.2
"""How far a robot is from a node at which it arrived, where nothing more is known: half of what counts as
there."""

ABOUT_M = 0.5
"""Who is nearer than this to a node, and whose place is known as well as that in a room, is about there;
chosen: nodes lie so far apart at the least, and a robot goes a third of a metre between two frames."""

COMPARED = 8
"""Nodes around the robot, or of the map, that are compared with its view; chosen: as goto does."""

log = logging.getLogger(__name__)


class Tracker:
    """Follows one robot through one map.

    Args:
        profile: thresholds.
        maps: the map.
        matcher: compares frames.
        certain: only a place without rivals counts where nobody knows where the robot is, and only a spot
            around which the same things stand: one that maps would join two places for good.
        whereabouts: as the mission before left them; this tracker changes them.

    Attributes:
        mistaken: by this frame the robot was not where it believed to be, nobody knows since when.
    """

    def __init__(
        self,
        profile: Profile,
        maps: MapAccess,
        matcher: Matcher,
        *,
        certain: bool,
        whereabouts: Whereabouts | None = None,
    ) -> None:
        self._profile, self._maps, self._matcher = profile, maps, matcher
        self._certain, self._sights = certain, Sights(profile, maps)
        self._at = whereabouts or Whereabouts()
        self._resumes = self._at.here is not None
        self._strict = profile.sensing.similarity == "raw"
        self._lost_frames = 0
        self._doubts, self._rivals = Doubts(), Rivals(profile, maps, self._sights, self._at)
        self.mistaken = False
        self._ranges: Ranges | None = None

    @property
    def here(self) -> Displacement | None:
        """Where the robot is relative to a node; None while nobody knows."""
        return self._at.here

    @here.setter
    def here(self, here: Displacement | None) -> None:
        self._at.here = here

    def observe(self, observation: Observation) -> None:
        """A new frame, and how far the robot went since the one before."""
        self._at.observe(observation.features, observation.moved)
        self._ranges, self.mistaken = observation.ranges, False
        self._doubts.went(observation.moved)
        self._rivals.went(observation.moved)
        if self.here is not None:
            self.here = self.here.moved(observation.moved)

    def nearby(self) -> list[int]:
        """Nodes around where the robot is."""
        return nodes_nearby(self._maps.graph, self.here, self._profile, COMPARED)

    @property
    def compared(self) -> int:
        """Nodes of the whole map to be compared with a frame on the way: none, but for now and then."""
        due = self._doubts.are_due or self._rivals.are_due
        return COMPARED if due and not (self._strict or self._certain) else 0

    @property
    def elsewhere(self) -> list[int]:
        """Nodes of other places where the robot may be, to be compared with a frame now and then."""
        return self._rivals.nodes()

    def stand_at(self, here: Displacement | None) -> None:
        """It is known where the robot is, or not any more."""
        self.here, self._lost_frames = here, 0
        self._doubts.settle()
        self._rivals.end()

    def shown(self, view: Matches) -> None:
        """A frame surely shows where it was taken: who sees only what lies elsewhere was mistaken.

        Args:
            view: the frame against the nodes of the whole map that are most like it.
        """
        if self.here is None:
            return
        within = in_reach(self._maps.graph, view, self.here, self._profile)
        if self._sights.is_within(within, view) is False:
            self._forget("the view at an arrival shows other places")

    def possible(self, matches: Matches, *, of_map: bool = False) -> Matches:
        """The matches that can be what they claim: those within reach, or of the likeliest place.

        Args:
            matches: of the frame.
            of_map: the nodes of the whole map that are most like it are among them.
        """
        graph = self._maps.graph
        if self._strict:
            return matches
        if self._certain:
            matches = {node: match for node, match in matches.items() if not self._is_double(match)}
        if self._resumes:
            self._resume()
        if self.here is not None and self.here.node_id in graph.nodes:
            if of_map and not self._certain:
                self._choose(self.here, matches)
            within = in_reach(graph, matches, self.here, self._profile)
            if of_map and self._is_refuted(matches, within):
                return self._likeliest(matches)
            if self._sights.any_sure(within):
                self._lost_frames = 0
                return self._sights.agreeing(within)
            self._lost_frames += 1
            if not self._is_away():
                return within
        return self._likeliest(matches)

    def confirm(self, matches: Matches) -> None:
        """Reckon from the node that the frame shows best, where that is surer than what was driven since.

        Args:
            matches: those that are possible.
        """
        nodes, best = self._maps.graph.nodes, self._sights.resected(matches)
        if best is None:
            return
        if self.here is None or best.spread_m <= self.here.spread_m or self.here.node_id not in nodes:
            self.here = best
        elif self.here.node_id in matches and (yaw := matches[self.here.node_id].yaw_rad) is not None:
            self.here = self.here.facing(-yaw)

    def standing_at(self, node_id: int, matches: Matches) -> Displacement:
        """Where the robot is relative to a node it travelled to, by what it sees and what it did.

        Args:
            node_id: the node.
            matches: of the frame, with the nodes around.
        """
        found = self._sights.resected(self.possible(matches), node_id, self.here)
        if found is not None:
            return found
        match = matches.get(node_id)
        yaw_rad = match.yaw_rad if match is not None and match.yaw_rad is not None else 0.0
        return Displacement(node_id, yaw_rad=-yaw_rad, spread_m=AT_NODE_M)

    def is_beyond(self, node_id: int) -> bool:
        """Whether the robot is surely not at a node, however little the bearings of far things differ."""
        graph, here = self._maps.graph, self.here
        if here is None or node_id not in graph.nodes:
            return False
        away_m = distances(graph, here, [node_id]).get(node_id, 0.0)
        return away_m > BEYOND_M * openness(graph, node_id) + BEYOND_STDS * here.spread_m

    def came_to(self, node_id: int, match: NodeMatch) -> bool:
        """Whether the robot is at a node by all that it saw and did, and sees no baseline to it."""
        graph, here = self._maps.graph, self.here
        if here is None or match.status != "no_baseline" or not self._sights.resembles(match):
            return False
        if here.spread_m > ABOUT_M * openness(graph, node_id):
            return False
        return distances(graph, here, [node_id]).get(node_id, math.inf) < ABOUT_M

    def was_carried(self) -> bool:
        """Whether this frame shows another place than the one before it."""
        match = self._against(self._at.before)
        return self._at.before is not None and (match is None or not self._sights.resembles(match))

    def likeness(self, s_goal: int) -> float:
        """Similarity of this frame to a picture, as a share of its similarity to a frame from beside it."""
        match = self._against(self._at.apart or self._at.before)
        return s_goal / max(similarity(match, self._profile) if match is not None else s_goal, 1)

    def _resume(self) -> None:
        """The first frame of a mission: the robot is where the last one left it, or somebody moved it."""
        self._resumes = False
        here, before = self.here, self._at.before
        if here is None or before is None or here.node_id not in self._maps.graph.nodes:
            self.stand_at(None)
            return
        seen = self._matcher.match([here.node_id], 0, (before,))
        stands = is_at(seen.get(GOAL), self._maps.graph, self._profile)
        if not stands or here.node_id not in seen or not self._sights.is_sure(seen[here.node_id]):
            log.info("not about node %d any more: where the robot is has to be seen", here.node_id)
            self.stand_at(None)

    def _is_double(self, match: NodeMatch) -> bool:
        """Whether a frame looks as if taken at a node around which other things stand."""
        node = self._maps.graph.nodes.get(match.node_id)
        if node is None or self._ranges is None or match.yaw_rad is None:
            return False
        at_node = is_at(match, self._maps.graph, self._profile)
        return at_node and is_elsewhere(node, self._ranges, match.yaw_rad)

    def _against(self, frame: Features | None) -> NodeMatch | None:
        """This frame against an earlier one."""
        return None if frame is None else self._matcher.match([], 0, (frame,)).get(GOAL)

    def _is_away(self) -> bool:
        """Whether the robot is not where its own motion says; that is forgotten then."""
        carried = self.was_carried()
        if not carried and self._lost_frames < PATIENCE_FRAMES:
            return False
        why = "the view changed at once" if carried else f"nothing seen for {self._lost_frames} frames"
        log.info("%s: no longer about node %d", why, self.here.node_id if self.here is not None else -1)
        self.stand_at(None)
        return True

    def _is_refuted(self, matches: Matches, within: Matches) -> bool:
        """Whether this and earlier views show other places than that where the robot believes to be."""
        if self._certain:  # who maps sees what is in no map yet
            return False
        is_here = self._sights.is_within(within, matches)
        if is_here:
            self._doubts.settle()
        if is_here is not False or not self._doubts.refute():
            return False
        self._forget("several views show other places")
        return True

    def _choose(self, here: Displacement, matches: Matches) -> None:
        """Go by another place that looked alike at first, where the views since speak for that."""
        self.here = self._rivals.choose(here, matches)
        if self.here is not here:
            log.info(
                "about node %d, not about node %d: views since tell them apart",
                self.here.node_id,
                here.node_id,
            )
            self._doubts.settle()
            self.mistaken = True

    def _forget(self, why: str) -> None:
        """The robot never was where it believed to be."""
        log.info("not about node %d: %s", self.here.node_id if self.here else -1, why)
        self.stand_at(None)
        self.mistaken = True

    def _likeliest(self, matches: Matches) -> Matches:
        """Of several places that look alike the one that resembles the view most."""
        found = self._sights.places(matches)
        if not found or (self._certain and len(found) > 1):
            return {}
        self._at.guessed = len(found) > 1
        self._rivals.begin(found, matches)
        log.info("about node %d, by what is seen", found[0].nodes[0])
        return {node: matches[node] for node in found[0].nodes}
