"""Edges of a new place that the map bears out: far ones need a witness, none may be outvoted. Pure.

Two streets of equal houses give matches that fit one motion of the camera. A neighbour of the place that is
claimed must then fit as well: the turn and the direction it is seen at follow from the edge between the two.
"""

from collections.abc import Mapping, Set

from services.planner.graph import MapGraph
from shared.mapgraph.triangle import Sight, triangle_closes
from shared.messages.matching import NodeMatch

NEAR_HOPS = 1
"""Within so many edges of the place the robot came from an edge closes no loop."""

FAR_HOPS = 3
"""Beyond so many edges a look-alike is as likely as the place itself: of 153 such edges in a village of equal
houses 58 were wrong, of 1195 nearer ones 11. None of the wrong ones had more than 106 verified matches."""


def unsupported_closures(
    graph: MapGraph, matches: Mapping[int, NodeMatch], driven_from: int | None, s_far: int = 0
) -> dict[int, str]:
    """Places of `matches` far from where the robot came from that no neighbour of theirs bears witness for.

    Beyond FAR_HOPS at least `s_far` verified matches are needed as well: the robot must nearly stand there.

    Args:
        graph: the map without the new place.
        matches: trusted matches of the new frame that would become edges.
        driven_from: the place the robot came from; None (the first place, or carried) asks for no witness.
        s_far: verified matches needed beyond FAR_HOPS.

    Returns:
        Place and reason.
    """
    if driven_from is None or driven_from not in graph.nodes:
        return {}
    near = graph.within(driven_from, NEAR_HOPS)
    far = far_places(graph, matches, driven_from) if s_far else set()
    refused = {}
    for place in sorted(set(matches) - near):
        if place in far and matches[place].inliers < s_far:
            refused[place] = f"node {place} is far in the map, {matches[place].inliers} of {s_far} matches"
            continue
        witnesses = [n for n in graph.neighbours(place) if n in matches]
        if any(agrees(graph, matches, place, witness) for witness in witnesses):
            continue
        refused[place] = f"{len(witnesses)} neighbours of node {place} seen, none agrees"
    return refused


def witnessed(graph: MapGraph, matches: Mapping[int, NodeMatch], sure: Set[int]) -> set[int]:
    """Places of `matches` that a neighbour among the sure ones bears witness for, or one so witnessed.

    Args:
        graph: the map.
        matches: trusted matches of the current frame.
        sure: places known to be in sight.

    Returns:
        The places, without the sure ones.
    """
    known, waiting = set(sure), sorted(set(sure))
    while waiting:
        witness = waiting.pop()
        for place in graph.neighbours(witness):
            if place in matches and place not in known and agrees(graph, matches, place, witness):
                known.add(place)
                waiting.append(place)
    return known - sure


def contradicted(
    graph: MapGraph, matches: Mapping[int, NodeMatch], voters: Mapping[int, NodeMatch] | None = None
) -> dict[int, str]:
    """Places that their neighbours in the map outvote, weakest case first.

    A wall whose pattern repeats gives a clear motion in a wrong direction; places seen beside it tell. Every
    pair of matched places with an edge between them agrees or not; the votes weigh as many matches as the
    voter has verified.

    Args:
        graph: the map.
        matches: the places to judge.
        voters: all places whose matches count, also those too ambiguous for an edge; None: only the judged.

    Returns:
        Place and reason.
    """
    votes = _votes(graph, matches, voters if voters is not None else matches)
    refused: dict[int, str] = {}
    while True:
        balance = {
            place: sum(vote for witness, vote in seen.items() if witness not in refused)
            for place, seen in votes.items()
            if place not in refused
        }
        worst = min(balance, key=lambda place: (balance[place], place), default=None)
        if worst is None or balance[worst] >= 0:
            return refused
        refused[worst] = f"{-balance[worst]} more matches of its neighbours speak against node {worst}"


def _votes(
    graph: MapGraph, matches: Mapping[int, NodeMatch], voters: Mapping[int, NodeMatch]
) -> dict[int, dict[int, int]]:
    """For each place the neighbours that can judge it: their verified matches, negative against it."""
    seen = {**voters, **matches}
    votes: dict[int, dict[int, int]] = {}
    for place in sorted(matches):
        votes[place] = {
            witness: seen[witness].inliers * (1 if agrees(graph, seen, place, witness) else -1)
            for witness in graph.neighbours(place)
            if witness in seen and _can_judge(graph, seen, place, witness)
        }
    return votes


def _can_judge(graph: MapGraph, matches: Mapping[int, NodeMatch], place: int, witness: int) -> bool:
    edge = graph.edge(place, witness)
    turns = (edge.yaw_ab_rad if edge else None, matches[place].yaw_rad, matches[witness].yaw_rad)
    return all(turn is not None for turn in turns)


def agrees(graph: MapGraph, matches: Mapping[int, NodeMatch], place: int, witness: int) -> bool:
    """Whether the turns add up round the triangle frame, place, witness, and its directions can close.

    Seen from the frame, the direction place -> witness must lie between the direction to the witness and the
    opposite of the direction to the place.
    """
    edge, to_place, to_witness = graph.edge(place, witness), matches[place], matches[witness]
    if edge is None or edge.yaw_ab_rad is None:
        return False
    turned_rad = edge.yaw_ab_rad if edge.a == place else -edge.yaw_ab_rad
    return triangle_closes(
        Sight(to_place.heading_rad, to_place.yaw_rad),
        Sight(to_witness.heading_rad, to_witness.yaw_rad),
        Sight(graph.heading(place, witness), turned_rad),
    )


def far_places(graph: MapGraph, matches: Mapping[int, NodeMatch], driven_from: int) -> set[int]:
    """Places of `matches` more than FAR_HOPS edges from where the robot came from."""
    return {n for n in matches if n in graph.nodes} - graph.within(driven_from, FAR_HOPS)
