"""What one frame says of where it was taken, by the map alone: of what came before it knows nothing. Pure."""

from services.planner.mapping.reach import claims
from services.planner.ports import MapAccess, Matches
from services.planner.profiles import Profile
from services.planner.similarity import similarity, tells_place
from shared.mapgraph.local.claims import Claim
from shared.mapgraph.local.displacement import Displacement
from shared.mapgraph.local.hypotheses import NEAR_NODES, Hypothesis, hypotheses
from shared.mapgraph.local.likely_places import likely
from shared.mapgraph.local.resection import resected
from shared.messages.matching import NodeMatch


class Sights:
    """Reads the matches of frames with nodes of one map.

    Args:
        profile: thresholds.
        maps: the map.
    """

    def __init__(self, profile: Profile, maps: MapAccess) -> None:
        self._profile, self._maps = profile, maps

    def resembles(self, match: NodeMatch) -> bool:
        """Whether enough agrees; of views 4 cm apart that tells no direction well."""
        return similarity(match, self._profile) > self._profile.travel.s_via_min

    def is_sure(self, match: NodeMatch) -> bool:
        """Whether a match says where its node is, and enough agrees."""
        return self.resembles(match) and tells_place(match, self._maps.graph, self._profile)

    def any_sure(self, matches: Matches) -> bool:
        """Whether any node is seen for sure."""
        return any(self.is_sure(match) for match in matches.values())

    def claims(self, matches: Matches) -> dict[int, Claim]:
        """What the frame claims for sure of nodes of the map."""
        nodes = self._maps.graph.nodes
        sure = {node: match for node, match in matches.items() if node in nodes and self.is_sure(match)}
        return claims(self._maps.graph, sure, self._profile)

    def places(self, matches: Matches) -> list[Hypothesis]:
        """Where the frame can have been taken, the likeliest first."""
        graph, sure = self._maps.graph, self.claims(matches)
        return likely(graph, sure, hypotheses(graph, sure))

    def groups(self, matches: Matches) -> list[Hypothesis]:
        """Nodes that agree on where the frame was taken, those with most support first."""
        return hypotheses(self._maps.graph, self.claims(matches))

    def is_within(self, reach: Matches, view: Matches) -> bool | None:
        """Whether a view is likely of a place with nodes within reach; None where it shows no place."""
        places = self.places(view)
        return any(node in reach for place in places for node in place.nodes) if places else None

    def agreeing(self, within: Matches) -> Matches:
        """Without those that put the robot elsewhere than most of them do, though they are in reach."""
        away = {node for place in self.groups(within)[1:] for node in place.nodes}
        return {node: match for node, match in within.items() if node not in away}

    def resected(
        self, matches: Matches, node_id: int | None = None, reckoned: Displacement | None = None
    ) -> Displacement | None:
        """Where the bearings of the nodes cross; None where they do not tell.

        Args:
            matches: of the frame.
            node_id: the node that the answer is relative to; None: the one seen nearest.
            reckoned: where the robot is by what it did.
        """
        sure = self.claims(matches)
        if node_id is None and not sure:
            return None
        about = min(sure, key=lambda node: (sure[node].length_m, node)) if node_id is None else node_id
        return resected(self._maps.graph, sure, about, NEAR_NODES, reckoned)
