"""The feature service on a real bus: frames in, features out, questions answered or refused."""

import threading
from concurrent.futures import ThreadPoolExecutor

import cv2
import numpy as np
import pytest

from experiments.phone_photos.taking import Shot, taken
from services.features import early_questions, service
from services.features.map_features.map_reader import PIECE, MapReader
from services.features.matching.requests import RequestError
from shared.bus import Bus, wait_until
from shared.geometry.photo.plane import USUAL_RAD
from shared.messages.features import ExtractPhotoRequest, ExtractRequest, Features
from shared.messages.inspections import CompareReply, CompareRequest
from shared.messages.matching import MatchReply, MatchRequest
from shared.messages.sensors import Frame
from shared.messages.simulation import Pose
from shared.queries import RefusedError
from shared.topics import COMPARE, EXTRACT, EXTRACT_PHOTO, FEATURES, FRAME, MATCH
from tests.integration.features.conftest import ANSWER_S
from tests.unit.services.features.room import render_room

PLACES_M = ((0.4, 0.0), (0.8, 0.3), (-1.0, 0.2), (-1.5, -0.6))


def frame_at(
    x_m: float, y_m: float, seq: int = 0, stamp_ns: int = 1, lockstep: bool = True, height_px: int = 256
) -> Frame:
    picture = render_room(x_m, y_m, 0.0, height_px)
    data = cv2.imencode(".jpg", picture, [cv2.IMWRITE_JPEG_QUALITY, 92])[1].tobytes()
    return Frame(
        robot="r1",
        seq=seq,
        stamp_ns=stamp_ns,
        lockstep=lockstep,
        encoding="jpeg",
        width_px=2 * height_px,
        height_px=height_px,
        data=data,
    )


def extract(bus: Bus, frame: Frame) -> Features:
    return bus.ask(EXTRACT, ExtractRequest(frame=frame), ANSWER_S)


def match(bus: Bus, **fields: object) -> MatchReply:
    return bus.ask(MATCH, MatchRequest(**{"map": "flat", **fields}), ANSWER_S, robot="r1")


def send_until_features(bus: Bus, frame: Frame) -> Features:
    inbox = bus.subscribe(FEATURES, robot="r1")
    publisher = bus.publisher(FRAME, robot="r1")
    got: list[Features] = []

    def arrived() -> bool:
        publisher.put(frame)
        features = inbox.wait(0.5)
        if features is not None and features.seq == frame.seq:
            got.append(features)
        return bool(got)

    assert wait_until(arrived, ANSWER_S)
    return got[0]


@pytest.mark.usefixtures("service")
def test_a_frame_becomes_features_and_the_same_frame_again_the_same_features(bus: Bus) -> None:
    frame = frame_at(0.0, 0.0, seq=4, stamp_ns=77)
    first, again = send_until_features(bus, frame), send_until_features(bus, frame)
    assert (first.seq, first.stamp_ns, first.robot, first.lockstep) == (4, 77, "r1", True)
    assert first.extract_ms == again.extract_ms > 0.0
    assert len(first.lonlat_rad) > 100
    assert cv2.imdecode(np.frombuffer(first.thumbnail, np.uint8), cv2.IMREAD_COLOR).shape == (400, 800, 3)
    np.testing.assert_array_equal(first.descriptors, again.descriptors)


def compare(bus: Bus, seq: int, reference: bytes) -> CompareReply:
    return bus.ask(COMPARE, CompareRequest(seq=seq, reference=reference), ANSWER_S, robot="r1")


@pytest.mark.usefixtures("service")
def test_a_frame_is_compared_with_an_earlier_picture_as_long_as_it_is_kept(bus: Bus) -> None:
    frame, earlier = frame_at(0.0, 0.0, seq=4, stamp_ns=77), frame_at(0.05, 0.0).data
    send_until_features(bus, frame)
    first = compare(bus, 4, b"")
    assert (first.picture, first.compared, first.stamp_ns) == (frame.data, False, 77)
    again = compare(bus, 4, earlier)
    assert (again.compared, again.regions) == (True, ())
    assert abs(again.yaw_rad) < np.deg2rad(1.0)
    with pytest.raises(RefusedError, match="frame 3 is not kept") as refused:
        compare(bus, 3, earlier)
    assert refused.value.code == "passing"
    with pytest.raises(RefusedError, match="JPEG"):
        compare(bus, 4, b"no picture")


@pytest.mark.usefixtures("service")
def test_extract_of_a_goal_picture_equals_the_features_of_the_same_frame(bus: Bus) -> None:
    frame = frame_at(0.0, 0.0, seq=4)
    np.testing.assert_array_equal(extract(bus, frame).lonlat_rad, send_until_features(bus, frame).lonlat_rad)


@pytest.mark.usefixtures("service")
def test_match_finds_the_places_in_order_and_follows_deltas(bus: Bus, store, monkeypatch) -> None:
    monkeypatch.setattr(
        "services.features.map_features.map_reader.DELTA_WAIT_S", ANSWER_S / 2
    )  # else it asks
    for node_id, place in enumerate(PLACES_M[:3]):
        store.add(node_id, extract(bus, frame_at(*place)), tell=False)
    current = extract(bus, frame_at(0.0, 0.0))
    reply = match(bus, features=current, node_ids=(2,), best_k=1, targets=(store.nodes[1],))
    assert [result.node_id for result in reply.results] == [0, -1, 2]
    assert (reply.map_revision, reply.max_similarity, reply.pipeline) == (3, 300, current.pipeline)
    nearest = reply.results[0]
    assert nearest.status == "ok"
    assert abs(nearest.heading_rad) < np.deg2rad(2.0)
    assert nearest.inliers == nearest.inlier_mask.sum()

    store.add(3, extract(bus, frame_at(*PLACES_M[3])))
    reply = match(bus, features=current, node_ids=(3,), map_revision=4, with_matches=False)
    assert [result.node_id for result in reply.results] == [3]
    assert reply.results[0].matches_rad is None
    assert (reply.map_revision, store.reads) == (4, 1)

    store.nodes.pop(0)
    store.reset()
    assert wait_until(lambda: match(bus, features=current, best_k=9).map_revision == 5, ANSWER_S)
    assert {result.node_id for result in match(bus, features=current, best_k=9).results} == {1, 2, 3}


@pytest.mark.usefixtures("service")
def test_a_lost_delta_or_a_node_not_seen_yet_makes_it_read_the_map_again(bus: Bus, store) -> None:
    current = extract(bus, frame_at(0.0, 0.0))
    assert match(bus, features=current, best_k=2).results == ()
    store.add(7, current, tell=False)
    assert match(bus, features=current, node_ids=(7,)).results[0].status == "no_baseline"
    store.add(8, current, tell=False)
    assert match(bus, features=current, best_k=2, map_revision=2).map_revision == 2
    assert store.reads == 3


@pytest.mark.usefixtures("service")
def test_a_large_map_is_read_in_pieces_and_a_place_that_goes_meanwhile_means_once_more(
    bus: Bus, store
) -> None:
    current = extract(bus, frame_at(0.0, 0.0))
    for node_id in range(PIECE + 3):
        store.nodes[node_id] = current
    store.going = (PIECE + 1,)
    assert match(bus, features=current, node_ids=(PIECE + 2,)).results[0].status == "no_baseline"
    assert (store.reads, store.pieces) == (2, [PIECE, PIECE, 2])
    with pytest.raises(RefusedError, match=r"no node \[251\]"):
        match(bus, features=current, node_ids=(PIECE + 1,))


def photo_features(bus: Bus) -> Features:
    """Of a photo taken at 0, 0 that looks to the left."""
    pose = Pose(x_m=0.0, y_m=0.0, yaw_rad=1.0)
    shot = Shot(pose, pitch_rad=0.0, roll_rad=0.0, fov_rad=1.4, fov_known=True, portrait=False)
    photo = taken(shot, lambda at: render_room(at.x_m, at.y_m, at.yaw_rad, 1024), USUAL_RAD)
    return bus.ask(EXTRACT_PHOTO, ExtractPhotoRequest(photo=photo), ANSWER_S)


@pytest.mark.usefixtures("service")
def test_a_photo_is_compared_with_the_pictures_of_places_each_looked_at_once(
    bus: Bus, store, monkeypatch
) -> None:
    """A frame has its turn in between: whoever asks meanwhile is told to ask again."""
    monkeypatch.setattr(service, "LOOKING_S", 1e-3)
    monkeypatch.setattr(service, "LOOKED_AT", 1)
    places = [extract(bus, frame_at(x, y, height_px=512)) for x, y in PLACES_M]
    for node_id, features in enumerate(places):
        store.add(node_id, features)
    photo, refusals = photo_features(bus), []

    def compared() -> MatchReply | None:
        try:
            return match(bus, map_revision=store.revision, features=photo, best_k=4)
        except RefusedError as error:
            refusals.append((error.code, str(error)[:10]))
            return None

    assert wait_until(lambda: compared() is not None, ANSWER_S)
    assert refusals == [("busy", f"{left} pictures") for left in (3, 2, 1)]
    assert sorted(store.pictured) == [0, 1, 2, 3]
    with_pictures = compared()
    store.add(1, places[1].model_copy(update={"thumbnail": b""}))
    assert wait_until(lambda: compared() is not None, ANSWER_S)
    assert store.pictured[4:] == [1]
    counts = [{m.node_id: m.raw_matches for m in reply.results} for reply in (with_pictures, compared())]
    assert counts[0][1] > 1.5 * counts[1][1], "it has no picture any more: only what frames are compared by"
    assert {n: c for n, c in counts[0].items() if n != 1} == {n: c for n, c in counts[1].items() if n != 1}


@pytest.mark.usefixtures("service")
def test_how_nodes_differ_as_pictures_is_told_of_those_asked_for_where_it_is_asked(bus: Bus, store) -> None:
    for node_id, place in enumerate(PLACES_M[:2]):
        store.add(node_id, extract(bus, frame_at(*place)))
    here = extract(bus, frame_at(*PLACES_M[0]))
    plain = match(bus, map_revision=store.revision, features=here, node_ids=(0, 1))
    assert [m.differences for m in plain.results] == [None, None]
    assert not store.pictured
    told = match(bus, features=here, node_ids=(0,), best_k=2, with_differences=True).results
    assert [m.node_id for m in told if m.differences is not None] == [0]
    assert told[0].differences.max() < 5.0
    assert store.pictured == [0]


@pytest.mark.usefixtures("service")
def test_without_a_store_that_shows_pictures_nodes_are_matched_all_the_same(
    bus: Bus, store, monkeypatch
) -> None:
    def silent(*_: object) -> None:
        raise RequestError("map store does not answer")

    store.add(0, extract(bus, frame_at(*PLACES_M[0])))
    here = extract(bus, frame_at(*PLACES_M[0]))
    assert match(bus, map_revision=store.revision, features=here, node_ids=(0,)).results
    monkeypatch.setattr(MapReader, "pictures", silent)
    (found,) = match(bus, features=here, node_ids=(0,), with_differences=True).results
    assert (found.status, found.differences) == ("no_baseline", None)


@pytest.mark.usefixtures("service")
def test_a_frame_asks_for_no_pictures(bus: Bus, store) -> None:
    store.add(0, extract(bus, frame_at(*PLACES_M[0])))
    match(bus, map_revision=1, features=extract(bus, frame_at(0.0, 0.0)), best_k=1)
    assert store.pictured == []


@pytest.mark.usefixtures("service")
def test_the_same_question_has_the_same_answer(bus: Bus, store) -> None:
    for node_id, place in enumerate(PLACES_M):
        store.add(node_id, extract(bus, frame_at(*place)), tell=False)
    send_until_features(bus, frame_at(0.1, 0.1, seq=9))
    replies = [match(bus, seq=9, best_k=3) for _ in range(2)]
    timeless = [reply.model_copy(update={"match_ms": 0.0, "verify_ms": 0.0}) for reply in replies]
    assert timeless[0].model_dump() == timeless[1].model_dump()


@pytest.mark.usefixtures("service", "store")
def test_a_question_that_comes_before_its_frame_is_answered_with_it(bus: Bus, monkeypatch) -> None:
    monkeypatch.setattr(early_questions, "EARLY_S", ANSWER_S)
    with ThreadPoolExecutor() as pool:
        early = pool.submit(match, bus, seq=9, best_k=1)
        missed = pool.submit(match, bus, seq=8, best_k=1)
        assert not wait_until(lambda: early.done() or missed.done(), timeout_s=1.0)
        send_until_features(bus, frame_at(0.0, 0.0, seq=9))
        assert early.result(ANSWER_S).seq == 9
        with pytest.raises(RefusedError, match="frame 8 is not kept"):
            missed.result(ANSWER_S)


@pytest.mark.usefixtures("service", "store")
def test_a_question_whose_frame_does_not_come_is_refused(bus: Bus) -> None:
    with pytest.raises(RefusedError, match=r"frame 5 has not come \(kept: none\)") as refused:
        match(bus, seq=5, best_k=1)
    assert refused.value.code == "passing"


@pytest.mark.usefixtures("service", "store")
def test_what_cannot_be_answered_is_refused_with_the_reason(bus: Bus) -> None:
    current = extract(bus, frame_at(0.0, 0.0))
    foreign = current.model_copy(update={"pipeline": "orb-equirectangular-150"})
    send_until_features(bus, frame_at(0.0, 0.0, seq=9))
    with pytest.raises(RefusedError, match=r"frame 5 is not kept \(kept: 9 to 9\)") as gone:
        match(bus, seq=5, best_k=1)
    assert gone.value.code == "passing"
    with pytest.raises(RefusedError, match="map 'cellar' is not known to the map store"):
        match(bus, map="cellar", features=current, best_k=1)
    with pytest.raises(RefusedError, match=r"map 'flat' has no node \[3\]"):
        match(bus, features=current, node_ids=(3,))
    with pytest.raises(RefusedError, match=r"target 1 was made by pipeline 'orb-.*runs 'sift-equi"):
        match(bus, features=current, targets=(foreign,))


@pytest.mark.usefixtures("service")
def test_match_without_a_map_store_says_so(bus: Bus) -> None:
    with pytest.raises(RefusedError, match="the map store is not up"):
        match(bus, features=extract(bus, frame_at(0.0, 0.0)), best_k=1)


@pytest.mark.usefixtures("service")
def test_junk_is_refused_and_the_service_goes_on(bus: Bus) -> None:
    good = frame_at(0.0, 0.0)
    for data, reason in (
        (b"no picture", "not a JPEG"),
        (good.data[: len(good.data) // 2], "cut short"),
        (render_jpeg(64), "announces 512 x 256, its JPEG is 64 x 32"),
    ):
        with pytest.raises(RefusedError, match=reason):
            extract(bus, good.model_copy(update={"data": data}))
    bus.publisher(FRAME, robot="r1").put(good.model_copy(update={"data": b"junk", "seq": 1}))
    assert send_until_features(bus, good.model_copy(update={"seq": 2})).seq == 2


def render_jpeg(width: int) -> bytes:
    return cv2.imencode(".jpg", np.zeros((width // 2, width, 3), np.uint8))[1].tobytes()


@pytest.mark.usefixtures("service")
def test_questions_are_answered_while_frames_come_faster_than_they_are_extracted(bus: Bus) -> None:
    current = extract(bus, frame_at(0.0, 0.0))
    data, stop = bytes(frame_at(0.0, 0.0).data), threading.Event()
    publisher, features = bus.publisher(FRAME, robot="r1"), bus.subscribe(FEATURES, robot="r1")

    def send() -> None:
        seq = 0
        while not stop.wait(0.005):
            seq += 1
            publisher.put(
                Frame(
                    robot="r1", seq=seq, stamp_ns=seq, encoding="jpeg", width_px=512, height_px=256, data=data
                )
            )

    def answered() -> bool:
        return match(bus, features=current, targets=(current,)).results[0].status == "no_baseline"

    sender = threading.Thread(target=send)
    sender.start()
    try:
        assert features.wait(ANSWER_S) is not None
        assert all(answered() for _ in range(5))
        # and between questions that do not end frames go on being extracted
        assert wait_until(lambda: answered() and features.take() is not None, ANSWER_S)
    finally:
        stop.set()
        sender.join()
