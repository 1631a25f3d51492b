"""What driving teaches about edges: each success and failure changes an edge, with its evidence. Pure.

An edge is never forgotten by default: it is suspended, which makes it the last resort, and restored when it
is driven or seen free again (thesis equation 6.4 deletes it for good after one bad frame, see Q12).
"""

from services.planner.ports import MapAccess, Note
from services.planner.profiles import Profile
from shared.mapgraph.graph import EdgeKey, edge_key
from shared.messages.maps import DeleteEdge, Edge, PutEdge
from shared.messages.matching import NodeMatch

DECAY = 0.6
"""Share of its confidence that an edge keeps through a failure; chosen: two failures leave about a third."""

RECOVERY = 0.5
"""Share of the way back to the confidence measured that a success brings; chosen: two nearly undo a
failure."""

CONFIDENCE_MIN = 0.2
"""Confidence below which an edge is suspended; chosen: what is left of 0.9 after three failures."""

FAILURES_MAX = 2
"""Failures after which an edge is suspended, and a node counts as unreachable (decision 0014)."""


class EdgeExperience:
    """Changes the edges of one map during one mission, and remembers what failed in it.

    Attributes:
        banned: edges not to be tried again for now.
        unreachable: nodes that no way was found to, twice.
        tried_again: bans were lifted: there is no way but those that failed.
    """

    def __init__(self, profile: Profile, maps: MapAccess) -> None:
        self._profile, self._maps = profile, maps
        self._stuck_at: dict[int, int] = {}
        self._before: dict[EdgeKey, Edge] = {}
        self.tried_again = False
        self.banned: set[EdgeKey] = set()
        self.unreachable: set[int] = set()

    def stuck(self, ends: EdgeKey | None, via: int) -> tuple[Note, ...]:
        """No way was found to node `via`, along an edge, or from where the robot stood when `ends` is None.

        An edge is banned at once; the second time the node is, with all that leads there.
        """
        self._stuck_at[via] = self._stuck_at.get(via, 0) + 1
        cut_off = self._stuck_at[via] >= FAILURES_MAX
        if cut_off:
            self.unreachable.add(via)
            self.banned |= {edge_key(via, n) for n in self._maps.graph.neighbours(via)}
        if ends is None:
            return ()
        self.banned.add(ends)
        return (self.failed(ends, "stuck", cut_off=cut_off),)

    def lift_bans(self) -> bool:
        """Lift all bans, once a mission: obstacles move, and a second try from elsewhere may succeed."""
        if self.tried_again or not (self.banned or self.unreachable):
            return False
        self.tried_again = True
        self.banned.clear()
        self.unreachable.clear()
        self._stuck_at.clear()
        return True

    def forget(self) -> None:
        """What failed were other edges: those blamed are as they were before this mission."""
        graph = self._maps.graph
        blamed = [edge for ends, edge in self._before.items() if graph.edge(*ends) is not None]
        if blamed:
            self._maps.commit([PutEdge(edge=edge) for edge in blamed])
        for learnt in (self._before, self._stuck_at, self.banned, self.unreachable):
            learnt.clear()

    def failed(self, ends: EdgeKey, why: str, *, cut_off: bool = False) -> Note:
        """An edge was driven in vain: it decays; the second time, or with little left, it is suspended."""
        edge = self._maps.graph.edge(*ends)
        if edge is None:
            return Note("edge_gone", f"edge {ends} is no longer in the map")
        self._before.setdefault(ends, edge)
        if self._profile.travel.delete_edges:
            self._maps.commit([DeleteEdge(a=edge.a, b=edge.b)])
            return Note("edge_deleted", f"edge {ends}: {why}")
        confidence, failures = DECAY * edge.confidence, edge.failures + 1
        suspended = cut_off or failures >= FAILURES_MAX or confidence < CONFIDENCE_MIN
        reason = f"{why} while driving, {failures} failures, {edge.traversals} successes"
        update = {"failures": failures, "suspended": suspended, "confidence": confidence, "why": reason[:200]}
        self._maps.commit([PutEdge(edge=edge.model_copy(update=update))])
        values = {"a": edge.a, "b": edge.b, "confidence": round(confidence, 3), "failures": failures}
        return Note("edge_suspended" if suspended else "edge_failed", f"edge {ends}: {reason}", dict(values))

    def driven(self, ends: EdgeKey, match: NodeMatch | None) -> Note | None:
        """An edge was driven from end to end; a note where that changes what is believed."""
        edge = self._maps.graph.edge(*ends)
        if edge is None:
            return None
        if edge.traversals and not (edge.failures or edge.suspended):
            return None
        self._maps.commit([PutEdge(edge=_restored(edge, match, "driven", traversals=edge.traversals + 1))])
        if not edge.suspended:
            return None
        return Note("edge_restored", f"edge {ends}: driven again after {edge.failures} failures")

    def seen_free(self, ends: EdgeKey, match: NodeMatch) -> Note | None:
        """A suspended edge is matched again over ground that the sensors see free: it is believed again."""
        edge = self._maps.graph.edge(*ends)
        if edge is None or not edge.suspended or ends in self.banned:
            return None
        why = f"seen free again, S {match.inliers}"
        self._maps.commit([PutEdge(edge=_restored(edge, match, why, traversals=edge.traversals))])
        return Note("edge_restored", f"edge {ends}: {why}")


def _restored(edge: Edge, match: NodeMatch | None, why: str, *, traversals: int) -> Edge:
    """The edge with one failure less and half of its lost confidence back."""
    measured = max(edge.confidence, match.confidence if match is not None else CONFIDENCE_MIN)
    update = {
        "traversals": traversals,
        "failures": max(0, edge.failures - 1),
        "suspended": False,
        "confidence": edge.confidence + RECOVERY * (measured - edge.confidence),
        "why": why,
    }
    return edge.model_copy(update=update)
