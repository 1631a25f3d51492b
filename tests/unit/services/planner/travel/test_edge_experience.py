"""What driving teaches about edges, with its evidence."""

from dataclasses import dataclass, field

import pytest

from services.planner.profiles import DEFAULT, THESIS
from services.planner.travel.edge_experience import EdgeExperience
from shared.mapgraph.graph import MapGraph
from shared.messages.maps import DeleteEdge, Edge, Node
from shared.messages.matching import NodeMatch

ENDS = (0, 1)


@dataclass
class Memory:
    graph: MapGraph = field(
        default_factory=lambda: MapGraph(
            [Node(node_id=n) for n in range(4)],
            [Edge(a=0, b=1, confidence=0.9), Edge(a=1, b=2, confidence=0.9), Edge(a=2, b=3, confidence=0.9)],
        )
    )

    def commit(self, operations):
        self.graph.apply(operations)


@pytest.fixture
def maps():
    return Memory()


def match(confidence=0.8):
    return NodeMatch(node_id=1, raw_matches=90, inliers=75, status="ok", confidence=confidence)


def test_an_edge_decays_with_each_failure_and_is_suspended_at_the_second(maps):
    experience = EdgeExperience(DEFAULT, maps)
    first = experience.failed(ENDS, "lost")
    once = maps.graph.edge(*ENDS)
    assert (first.kind, once.suspended, once.failures) == ("edge_failed", False, 1)
    second = experience.failed(ENDS, "lost")
    twice = maps.graph.edge(*ENDS)
    assert (second.kind, twice.suspended) == ("edge_suspended", True)
    assert twice.confidence < once.confidence < 0.9
    assert "lost while driving, 2 failures" in twice.why


def test_a_suspended_edge_that_is_driven_is_believed_again(maps):
    experience = EdgeExperience(DEFAULT, maps)
    experience.failed(ENDS, "lost")
    experience.failed(ENDS, "lost")
    worn = maps.graph.edge(*ENDS)
    note = experience.driven(ENDS, match())
    edge = maps.graph.edge(*ENDS)
    assert note.kind == "edge_restored"
    assert (edge.suspended, edge.failures, edge.traversals) == (False, 1, 1)
    assert edge.confidence > worn.confidence


def test_driving_a_good_edge_again_writes_nothing(maps):
    experience = EdgeExperience(DEFAULT, maps)
    experience.driven(ENDS, match())
    before = maps.graph.edge(*ENDS)
    assert experience.driven(ENDS, match()) is None
    assert maps.graph.edge(*ENDS) is before


def test_a_suspended_edge_seen_free_is_restored_unless_it_failed_just_now(maps):
    EdgeExperience(DEFAULT, maps).stuck(ENDS, via=1)
    late = EdgeExperience(DEFAULT, maps)
    late.stuck(ENDS, via=1)
    assert maps.graph.edge(*ENDS).suspended
    assert late.seen_free(ENDS, match()) is None
    note = EdgeExperience(DEFAULT, maps).seen_free(ENDS, match())
    assert note.kind == "edge_restored"
    assert not maps.graph.edge(*ENDS).suspended
    assert "seen free again, S 75" in maps.graph.edge(*ENDS).why


def test_a_place_that_no_way_was_found_to_twice_is_closed_and_forgiven_once(maps):
    experience = EdgeExperience(DEFAULT, maps)
    experience.stuck((0, 1), via=1)
    assert (experience.banned, experience.unreachable) == ({(0, 1)}, set())
    experience.stuck(None, via=1)
    assert experience.unreachable == {1}
    assert experience.banned == {(0, 1), (1, 2)}
    assert experience.lift_bans()
    assert not experience.banned | experience.unreachable
    experience.stuck((0, 1), via=1)
    assert not experience.lift_bans()


def test_the_thesis_deletes_at_once(maps):
    note = EdgeExperience(THESIS, maps).failed(ENDS, "lost")
    assert note.kind == "edge_deleted"
    assert maps.graph.edge(*ENDS) is None
    assert EdgeExperience(THESIS, maps).failed(ENDS, "lost").kind == "edge_gone"


def test_what_failed_elsewhere_is_forgotten(maps):
    """The robot was not where it believed to be: those edges were never driven."""
    before = dict(maps.graph.edges)
    experience = EdgeExperience(DEFAULT, maps)
    experience.stuck(ENDS, 1)
    experience.stuck(ENDS, 1)
    experience.failed((2, 3), "lost")
    assert maps.graph.edge(*ENDS).suspended
    experience.forget()
    assert dict(maps.graph.edges) == before
    assert (experience.banned, experience.unreachable) == (set(), set())
    assert experience.failed(ENDS, "lost").kind == "edge_failed"


def test_an_edge_that_is_gone_meanwhile_stays_gone(maps):
    experience = EdgeExperience(DEFAULT, maps)
    experience.failed(ENDS, "lost")
    maps.commit([DeleteEdge(a=0, b=1)])
    experience.forget()
    assert maps.graph.edge(*ENDS) is None
