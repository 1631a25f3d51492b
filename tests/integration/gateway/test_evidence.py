"""What speaks for a connection, and what the robot recognises now."""

import httpx
import numpy as np

from shared.bus import Bus, wait_until
from shared.messages.matching import NodeMatch
from shared.messages.sensors import Frame
from shared.topics import FRAME
from tests.integration.gateway.standins import FeatureService


def send_frame(http: httpx.Client, bus: Bus, seq: int) -> None:
    publisher = bus.publisher(FRAME, robot="r1")
    pixels = np.zeros((128, 256, 3), np.uint8).tobytes()

    def arrived() -> bool:
        publisher.put(Frame(seq=seq, robot="r1", encoding="bgr8", width_px=256, height_px=128, data=pixels))
        return http.get("/api/robots/r1/frame.jpg").headers.get("x-frame-seq") == str(seq)

    assert wait_until(arrived, 20.0)


def test_the_newest_picture_is_compared_with_a_place(
    http: httpx.Client, robot_bus: Bus, features: FeatureService
) -> None:
    send_frame(http, robot_bus, 77)
    bearings = np.array([[0.1, 0.2, 0.3, 0.4], [1.0, 0.0, -1.0, 0.0]], np.float32)
    match = NodeMatch(
        node_id=7,
        raw_matches=2,
        inliers=1,
        status="ok",
        heading_rad=0.5,
        matches_rad=bearings,
        inlier_mask=np.array([1, 0], np.uint8),
    )
    before, features.results = features.results, (match,)
    try:
        answer = http.get("/api/robots/r1/matches?map=flat&node=7").json()
    finally:
        features.results = before
    assert (answer["picture"], answer["node_id"], answer["heading_rad"]) == ("frame 77", 7, 0.5)
    assert answer["inlier"] == [True, False]
    np.testing.assert_allclose(answer["matches_rad"], bearings, atol=1e-5)
    asked = features.matched[-1]
    assert (asked.seq, asked.node_ids, asked.with_matches) == (77, (7,), True)


def test_a_picture_that_the_feature_service_does_not_have_yet_is_asked_about_again(
    http: httpx.Client, robot_bus: Bus, features: FeatureService
) -> None:
    send_frame(http, robot_bus, 79)
    features.behind = 2
    assert http.get("/api/robots/r1/matches?map=flat&node=7").json()["node_id"] == 7
    features.behind, asked = 100, len(features.matched)
    answer = http.get("/api/robots/r1/matches?map=flat&node=7")
    features.behind = 0
    assert (answer.status_code, answer.json()["reason"]) == (409, "passing")
    assert len(features.matched) - asked == 5


def test_an_answer_about_another_place_is_refused(http: httpx.Client, robot_bus: Bus) -> None:
    send_frame(http, robot_bus, 78)
    answer = http.get("/api/robots/r1/matches?map=flat&node=5")
    assert (answer.status_code, answer.json()["expected"]) == (502, "matches of node 5")


def test_a_robot_nobody_heard_of_is_named(http: httpx.Client) -> None:
    answer = http.get("/api/robots/nobody/matches?map=flat&node=7")
    assert (answer.status_code, answer.json()["got"]) == (404, "nobody")


def test_without_a_map_store_on_the_bus_an_edge_has_no_evidence(http: httpx.Client) -> None:
    answer = http.get("/api/maps/flat/edges/3/7/matches")
    assert (answer.status_code, answer.json()["service"]) == (503, "map_store")
