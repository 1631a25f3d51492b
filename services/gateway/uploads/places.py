"""Where in the map a picture was taken: the places that its matches speak for."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Literal

from services.gateway.state import Gateway
from shared.mapgraph.graph import MapGraph
from shared.mapgraph.local.claims import claim_of, is_claim
from shared.mapgraph.local.hypotheses import Hypothesis, hypotheses
from shared.mapgraph.local.likely_places import is_plain, likely, typical_similarity
from shared.messages.maps import MapRequest
from shared.messages.matching import MatchReply, NodeMatch
from shared.topics import MAP
from shared.web.problems import ProblemError

INLIERS_MIN = 22
"""Fewer prove nothing: no bearing of a pair with more was wrong by 20 degrees (`topnav calibrate`)."""

AWAY = (503, 504)
"""Of a service that is absent or too slow."""

Verdict = Literal["found", "ambiguous", "weak", "not_found"]


@dataclass(frozen=True)
class Places:
    """Where a picture can have been taken, and what people are told; the planner decides itself.

    Attributes:
        likely: the likeliest first.
    """

    verdict: Verdict
    likely: list[Hypothesis]


async def places_of(gateway: Gateway, reply: MatchReply) -> Places:
    """Where the picture of an answer can have been taken.

    While the map store is away nobody knows which nodes are one place: then no place is named.
    """
    timeout_s = gateway.settings.compute_timeout_s
    sure = [match for match in reply.results if match.inliers > INLIERS_MIN and is_claim(match)]
    if not sure:
        agreeing = any(match.status in ("ok", "no_baseline") for match in reply.results)
        return Places("weak" if agreeing else "not_found", [])
    wish = MapRequest(action="read")
    try:
        found = await gateway.asker.ask("map_store", MAP, wish, timeout_s, map=reply.map)
    except ProblemError as problem:
        if problem.status_code not in AWAY:
            raise
        return Places("weak", [])
    return await gateway.work(lambda: judged(MapGraph(found.nodes, found.edges), sure))


def judged(graph: MapGraph, sure: Sequence[NodeMatch]) -> Places:
    """The places that matches speak for."""
    said = {match.node_id: claim_of(graph, match.node_id, match) for match in sure}
    claims = {node: claim for node, claim in said.items() if claim is not None}
    left = likely(graph, claims, hypotheses(graph, claims))
    plain = is_plain(left, typical_similarity(graph))
    return Places("ambiguous" if len(left) > 1 else "found" if plain else "weak", left)
