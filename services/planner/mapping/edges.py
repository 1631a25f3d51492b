"""Which edges a new node gets (thesis equation 4.1, decision 0015). Pure.

A match becomes an edge when

1. its similarity is above s_edge_min and two-view geometry is sure of its bearing (`_admitted`),
2. it is the node the robot came from; or the bearing is surer still and what agrees is not far away
   (`_is_credible`),
3. the node lies where the frame sees it and not too far for an edge, the less so where no ground was seen
   free, as far as the robot knows what it did (`reach`),
4. one motion alone explains it (`rival_motion`),
5. a neighbour supports it where it would close a loop, and its neighbours do not contradict it
   (`shared.mapgraph.cycle_consistency`).
"""

from dataclasses import dataclass, field

from services.planner.mapping.reach import no_edges
from services.planner.mapping.rival_motion import is_ambiguous
from services.planner.ports import Matches, Observation
from services.planner.profiles import Profile
from services.planner.similarity import similarity, trusted
from services.planner.surroundings import is_clear, is_clear_from
from shared.mapgraph.cycle_consistency import contradicted, supported_by, unsupported_loop_closures
from shared.mapgraph.graph import MapGraph
from shared.mapgraph.local.displacement import Displacement
from shared.messages.matching import NodeMatch

CONFIDENCE_MIN = 0.5
"""Of the two-view geometry of an edge: at one half its two directions explain the matches equally well."""

SURE_MIN = 0.7
"""The same for an edge that nobody drove. In five yards of 80 such edges with less 5 were wrong by more than
10 degrees, of 57 with 0.7 to 0.8 none; an apartment has 2 of 79 with less (decision 0047)."""


@dataclass(frozen=True)
class NewEdges:
    """The nodes that a new frame resembles: those that get an edge, and why the others do not.

    Attributes:
        admitted: those that get one.
        clear: those with free ground seen all the way.
        refused: node and reason.
        covered: too uncertain for an edge, but there: nothing is unexplored that way.
    """

    admitted: Matches = field(default_factory=dict)
    clear: frozenset[int] = frozenset()
    refused: dict[int, str] = field(default_factory=dict)
    covered: Matches = field(default_factory=dict)


def judge_edges(
    graph: MapGraph,
    observation: Observation,
    matches: Matches,
    profile: Profile,
    here: Displacement | None,
) -> NewEdges:
    """Which edges a new node gets.

    Args:
        graph: the map without the new node.
        observation: the frame and the distances around.
        matches: the frame against the nodes of the map.
        profile: thresholds.
        here: where the robot is relative to the node it came from; None where nobody knows.
    """
    driven_from = here.node_id if here is not None else None
    known = {n: m for n, m in matches.items() if n in graph.nodes}
    alike = {n: m for n, m in known.items() if _admitted(m, profile)}
    free = {
        n
        for n, m in alike.items()
        if is_clear(m, graph, observation.ranges, profile) or is_clear_from(graph.nodes[n], m, graph, profile)
    }
    away = no_edges(graph, known, here, profile, known.keys() - free)
    similar = {n: m for n, m in alike.items() if n not in away}
    clear = frozenset(free & similar.keys())
    credible = {n: m for n, m in similar.items() if n == driven_from or _is_credible(m, profile)}
    refused = {} if profile.sensing.similarity == "raw" else _refused(graph, credible, driven_from)
    admitted = {n: m for n, m in credible.items() if n not in refused}
    covered = {n: similar[n] for n in supported_by(graph, similar, set(admitted))}
    return NewEdges(admitted, clear, away | refused, covered)


def stands_alone(match: NodeMatch, profile: Profile) -> bool:
    """Whether a match becomes an edge by itself: no map, no drive and no free ground speak for it."""
    admitted = _admitted(match, profile) and _is_credible(match, profile)
    return admitted and (profile.sensing.similarity == "raw" or not is_ambiguous(match))


def _admitted(match: NodeMatch, profile: Profile) -> bool:
    """Edge rule 4.1; verified similarity also asks for trusted geometry that is sure of its direction."""
    if similarity(match, profile) <= profile.mapping.s_edge_min:
        return False
    if profile.sensing.similarity == "raw":
        return True
    sure = match.heading_rad is not None and match.confidence >= CONFIDENCE_MIN
    return sure and trusted(match, profile) and _here(match, profile)


def _here(match: NodeMatch, profile: Profile) -> bool:
    """Whether what agrees stands in this very place: it moves as the camera does, and fits it closely.

    A view that has hardly changed is close by, or far things alone agree: a profile that asks for what moved
    refuses both.
    """
    rules = profile.mapping
    noise, disparity = match.noise_rad, match.disparity_rad
    noisy = rules.noise_max_rad and (noise is None or noise > rules.noise_max_rad)
    blurred = rules.blur_max and (noise is None or disparity is None or noise > rules.blur_max * disparity)
    return not (noisy or blurred) and (match.moved or 0) >= rules.moved_min


def _is_credible(match: NodeMatch, profile: Profile) -> bool:
    """Whether a view alone makes an edge, without a drive along it."""
    sure = profile.sensing.similarity == "raw" or match.confidence >= SURE_MIN
    return sure and _is_near(match, profile)


def _is_near(match: NodeMatch, profile: Profile) -> bool:
    """Whether what agrees is not far away: few matches that hardly move may be, and so may the node."""
    rules, disparity_rad = profile.mapping, match.disparity_rad or 0.0
    return disparity_rad >= rules.far_rad or similarity(match, profile) >= rules.s_sure


def _refused(graph: MapGraph, credible: Matches, driven_from: int | None) -> dict[int, str]:
    """Edges that are ambiguous, unsupported or outvoted.

    The view of the node the robot came from was followed frame by frame, so it is not ambiguous.
    """
    why = "two motions explain the view of node"
    refused = {n: f"{why} {n}" for n, m in credible.items() if n != driven_from and is_ambiguous(m)}
    left = {n: m for n, m in credible.items() if n not in refused}
    refused |= unsupported_loop_closures(graph, left, driven_from)
    left = {n: m for n, m in credible.items() if n not in refused}
    return refused | contradicted(graph, left, credible)
