"""Merging in the store: one revision with the blobs that are there, or nothing at all."""

import threading
from collections.abc import Callable, Mapping
from unittest.mock import Mock

import numpy as np
import pytest

from services.map_store.integrity.check import check
from services.map_store.merging.merge import Merge, ReadMap
from services.map_store.merging.merges import Merges
from services.map_store.store import MapStore
from shared.bus import wait_until
from shared.messages.maps import AddNode, DeleteNode, Node, PutEdge
from shared.messages.matching import MatchReply, MatchRequest, NodeMatch
from shared.messages.places import (
    KeepOut,
    Marks,
    Place,
    PutPlace,
    PutRoute,
    PutRule,
    PutSign,
    Route,
    Sighting,
    Sign,
)
from shared.queries import AbsentError, RefusedError
from shared.wire import encode
from tests.merge_world import KEYPOINTS, PIPELINE, Pose, edges_of, features_of, matches_of, row
from tests.unit.services.map_store.conftest import Told
from tests.unit.services.map_store.test_store import damage

END_S = 30.0
RNG = np.random.default_rng(5)
HALL = dict(enumerate(row(RNG, 0.0, 0.0, 8)))
WING = {5 * k + 2: pose for k, pose in enumerate(row(RNG, 5.2, 0.3, 7))}
FOUND = matches_of(HALL, WING, np.random.default_rng(0))
FIRST = 1_000
"""Features of node n of the wing have the number FIRST + n."""


def fill(store: MapStore, name: str, poses: Mapping[int, Pose], first: int) -> None:
    nodes = {n: Node(node_id=n, stamp_ns=7 + n, pipeline=PIPELINE, keypoints=KEYPOINTS) for n in poses}
    adds = [AddNode(node=node, features=features_of(first + n)) for n, node in nodes.items()]
    store.create(name)
    store.transact(name, [*adds, *(PutEdge(edge=edge) for edge in edges_of(poses, RNG))])


@pytest.fixture
def maps(store: MapStore, told: Told) -> MapStore:
    """A store with the maps "hall" and "wing"."""
    fill(store, "hall", HALL, 0)
    fill(store, "wing", WING, FIRST)
    told.clear()
    return store


def matches(wish: MatchRequest) -> MatchReply:
    assert wish.features is not None
    found: tuple[NodeMatch, ...] = tuple(FOUND[wish.features.seq - FIRST])
    return MatchReply(map=wish.map, pipeline=PIPELINE, max_similarity=150, results=found)


def merge_of(store: MapStore, match: Callable[[MatchRequest], MatchReply] = matches) -> Merge:
    return Merge(store, match, ReadMap.newest(store, "hall"), ReadMap.newest(store, "wing"), "anna")


def test_the_other_map_becomes_part_of_the_base_in_one_revision(maps: MapStore, told: Told):
    merge = merge_of(maps)
    merge.run()
    answer = merge.progress.answer
    assert (answer.state, answer.matched, answer.reason) == ("done", len(WING), "")
    assert [(delta.map, delta.revision, delta.reset, delta.author) for delta in told] == [
        ("hall", 2, True, "anna")
    ]
    _, graph = maps.graph("hall")
    ids = {old: 8 + k for k, old in enumerate(WING)}
    assert set(graph.nodes) == set(HALL) | set(ids.values())
    assert sum(edge.why == "merged" for edge in graph.edges.values()) == answer.cross_edges >= 6
    for part in maps.contents.features("hall", list(ids.values()))[1]:
        old = next(n for n, new in ids.items() if new == part.node_id)
        assert encode(part.features) == encode(features_of(FIRST + old).model_copy(update={"thumbnail": b""}))
        picture = maps.contents.read("hall", graph.nodes[part.node_id], "thumbnail")
        assert picture == features_of(FIRST + old).thumbnail
    assert check(maps.database) == []


def test_pictures_outlive_the_map_they_came_from_and_an_undo_takes_all_back(maps: MapStore):
    before = maps.graph("hall")[1]
    merge_of(maps).run()
    maps.delete("wing")
    assert len(maps.contents.features("hall", [])[1]) == len(HALL) + len(WING)
    assert check(maps.database) == []
    maps.undo("hall")
    after = maps.graph("hall")[1]
    assert (dict(after.nodes), dict(after.edges)) == (dict(before.nodes), dict(before.edges))


def test_routes_come_along_with_the_numbers_that_their_nodes_have_now(maps: MapStore):
    here, there = Route(name="tour", nodes=(0, 1, 2)), Route(name="Tour", nodes=(2, 7, 12, 7))
    maps.transact("hall", [PutRoute(route=here)])
    maps.transact("wing", [PutRoute(route=there)])
    merge_of(maps).run()
    ids = {old: 8 + k for k, old in enumerate(WING)}
    moved = Route(name="Tour (wing)", nodes=(ids[2], ids[7], ids[12], ids[7]))
    assert maps.graph("hall")[1].marks.routes == (here, moved)


def test_what_both_maps_read_is_one_sign_seen_from_the_nodes_of_both(maps: MapStore):
    def seen(node: int, height_rad: float) -> Sighting:
        return Sighting(node=node, bearing_rad=0.0, height_rad=height_rad, confidence=1.0)

    maps.transact("hall", [PutSign(sign=Sign(name="214", sightings=(seen(1, 0.1),)))])
    maps.transact("wing", [PutSign(sign=Sign(name="214", sightings=(seen(7, 0.2),)))])
    merge_of(maps).run()
    moved = 8 + list(WING).index(7)
    joined = Sign(name="214", sightings=(seen(moved, 0.2), seen(1, 0.1)))
    assert maps.graph("hall")[1].marks.signs == (joined,)


def test_names_and_rules_come_along_and_where_both_have_one_neither_is_lost(maps: MapStore):
    hall_name, wing_name = Place(name="Dock", nodes=(3,)), Place(name="dock", nodes=(7, 2))
    maps.transact("hall", [PutPlace(place=hall_name)])
    kept_out = KeepOut(name="closed", areas=("dock",))
    maps.transact("wing", [PutPlace(place=wing_name), PutRule(rule=kept_out)])
    merge_of(maps).run()
    marks = maps.graph("hall")[1].marks
    ids = {old: 8 + k for k, old in enumerate(WING)}
    assert marks.places == (hall_name, Place(name="dock (wing)", nodes=(ids[7], ids[2])))
    assert marks.rules == (KeepOut(name="closed", areas=("dock (wing)",)),)
    maps.undo("hall")
    assert maps.graph("hall")[1].marks == Marks(places=(hall_name,))
    assert check(maps.database) == []


def replaced(store: MapStore, name: str) -> None:
    """Another map takes a map's name and comes to the same revision with the same nodes."""
    poses = HALL if name == "hall" else WING
    store.delete(name)
    fill(store, name, poses, 5_000)


@pytest.mark.parametrize(
    ("change", "reason"),
    [
        (lambda store: store.transact("hall", [DeleteNode(node_id=0)]), "'hall' is at revision 2, not 1"),
        (lambda store: store.transact("wing", [DeleteNode(node_id=2)]), "'wing' was changed while it was"),
        (lambda store: store.delete("wing"), "no map 'wing'"),
        (lambda store: replaced(store, "hall"), "'hall' is another one than was read"),
        (lambda store: replaced(store, "wing"), "'wing' was changed while it was"),
    ],
)
def test_a_map_that_changes_meanwhile_is_left_alone(
    maps: MapStore, monkeypatch: pytest.MonkeyPatch, change: Callable[[MapStore], object], reason: str
):
    monkeypatch.setattr("services.map_store.merging.merge.CHUNK", 2)
    changes = [change]

    def meanwhile(wish: MatchRequest) -> MatchReply:
        if changes:
            changes.pop()(maps)
        return matches(wish)

    merge = merge_of(maps, meanwhile)
    merge.run()
    assert merge.progress.answer.state == "refused"
    assert reason in merge.progress.answer.reason
    assert all(node_id in HALL for node_id in maps.graph("hall")[1].nodes)


def test_a_map_deleted_when_all_was_read_takes_its_pictures_with_it(maps: MapStore):
    def at_the_end(wish: MatchRequest) -> MatchReply:
        if wish.features is not None and wish.features.seq == FIRST + max(WING):
            maps.delete("wing")
        return matches(wish)

    merge = merge_of(maps, at_the_end)
    merge.run()
    assert merge.progress.answer.state == "refused"
    assert "are no longer there" in merge.progress.answer.reason
    assert maps.summary("hall").revision == 1


@pytest.mark.parametrize(
    ("error", "state", "reason"),
    [
        (RefusedError("another pipeline"), "refused", "the feature service refused: another pipeline"),
        (AbsentError("nobody answers"), "failed", "no answer of the feature service: nobody answers"),
        (RuntimeError("a bug"), "failed", "an error in the map store: see its log"),
    ],
)
def test_what_goes_wrong_with_matching_is_the_reason(
    maps: MapStore, error: Exception, state: str, reason: str
):
    def fails(_wish: MatchRequest) -> MatchReply:
        raise error

    merge = merge_of(maps, fails)
    merge.run()
    assert merge.progress.answer.state == state
    assert merge.progress.answer.reason.startswith(reason)


def test_matches_with_a_newer_revision_are_not_trusted(maps: MapStore):
    merge = merge_of(maps, lambda wish: matches(wish).model_copy(update={"map_revision": 2}))
    merge.run()
    assert merge.progress.answer.reason == "map 'hall' was changed while it was matched: try again"


def test_damaged_features_are_named(maps: MapStore):
    damage(maps.database, maps.graph("wing")[1].nodes[7].features)
    merge = merge_of(maps)
    merge.run()
    assert merge.progress.answer.state == "refused"
    assert "map 'wing': the features of node 7 are damaged" in merge.progress.answer.reason


class Gate:
    """Answers once it is open."""

    def __init__(self) -> None:
        self.opened, self.asked = threading.Event(), threading.Event()

    def __call__(self, wish: MatchRequest) -> MatchReply:
        self.asked.set()
        assert self.opened.wait(END_S)
        return matches(wish)


def test_one_merge_at_a_time_and_a_cancelled_one_writes_nothing(maps: MapStore):
    gate = Gate()
    merges = Merges(maps, gate)
    hall, wing = ReadMap.newest(maps, "hall"), ReadMap.newest(maps, "wing")
    first = merges.start(hall, wing, "anna")
    assert first is not None
    assert gate.asked.wait(END_S)
    assert merges.running is first
    assert merges.start(wing, hall, "ben") is None
    assert merges.last("wing") is None
    assert first.progress.cancel()
    assert first.progress.answer.reason == "cancelled: nothing was written"
    second = merges.start(hall, wing, "ben")
    gate.opened.set()
    assert second is not None
    assert wait_until(lambda: not second.progress.running, END_S)
    assert second.progress.answer.state == "done"
    assert first.progress.answer.state == "refused"
    assert merges.last("hall") is second
    assert [entry.author for entry in maps.revisions("hall", 99, 99)] == ["ben", ""]
    assert second.progress.cancel()
    assert second.progress.answer.state == "done"


def test_a_store_that_stops_ends_its_merge(maps: MapStore):
    gate = Gate()
    merges = Merges(maps, gate)
    merge = merges.start(ReadMap.newest(maps, "hall"), ReadMap.newest(maps, "wing"), "anna")
    assert merge is not None
    assert gate.asked.wait(END_S)
    merges.close()
    gate.opened.set()
    assert merge.progress.answer.state == "refused"
    assert maps.summary("hall").revision == 1


def test_a_merge_that_gets_no_thread_has_failed_and_the_next_one_may_begin(maps: MapStore):
    merges = Merges(maps, matches)
    hall, wing = ReadMap.newest(maps, "hall"), ReadMap.newest(maps, "wing")
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(threading.Thread, "start", Mock(side_effect=RuntimeError("can't start new thread")))
        refused = merges.start(hall, wing, "anna")
    assert refused is not None
    assert refused is merges.last("hall")
    assert refused.progress.answer.state == "failed"
    assert "can't start new thread" in refused.progress.answer.reason
    merges.close()
    merge = merges.start(hall, wing, "anna")
    assert merge is not None
    assert wait_until(lambda: merge.progress.answer.state == "done", END_S)


def test_what_is_being_written_cannot_be_cancelled(maps: MapStore, monkeypatch: pytest.MonkeyPatch):
    merge, cancelled = merge_of(maps), []
    write = maps.add_stored

    def cancel_first(*args: object) -> int:
        cancelled.append(merge.progress.cancel())
        return write(*args)  # type: ignore[arg-type]

    monkeypatch.setattr(maps, "add_stored", cancel_first)
    merge.run()
    assert cancelled == [False]
    assert merge.progress.answer.state == "done"


def test_only_the_last_merges_are_remembered(maps: MapStore, monkeypatch: pytest.MonkeyPatch):
    monkeypatch.setattr("services.map_store.merging.merges.KEPT", 1)
    merges = Merges(maps, matches)
    for base, other in (("hall", "wing"), ("wing", "hall")):
        merge = merges.start(ReadMap.newest(maps, base), ReadMap.newest(maps, other), "anna")
        assert merge is not None
        assert wait_until(lambda merge=merge: not merge.progress.running, END_S)
    assert merges.last("hall") is None
    assert merges.last("wing") is not None
