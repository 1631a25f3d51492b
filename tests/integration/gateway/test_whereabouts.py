"""Where a robot is, by what it sees now."""

import httpx

from shared.bus import Bus
from shared.mapgraph.local.hypotheses import COMPARED_NODES
from tests.integration.gateway.standins import FeatureService
from tests.integration.gateway.test_evidence import send_frame


def test_a_robot_is_where_its_newest_picture_was_taken(
    http: httpx.Client,
    robot_bus: Bus,
    features: FeatureService,
    map_store: None,  # noqa: ARG001
) -> None:
    send_frame(http, robot_bus, 91)
    answer = http.get("/api/robots/r1/whereabouts?map=flat").json()
    assert (answer["frame_seq"], answer["verdict"]) == (91, "found")
    assert [place["nodes"] for place in answer["places"]] == [[7]]
    asked = features.matched[-1]
    assert (asked.seq, asked.best_k, asked.node_ids, asked.with_matches) == (91, COMPARED_NODES, (), False)


def test_a_robot_that_nobody_heard_of_is_nowhere(http: httpx.Client) -> None:
    answer = http.get("/api/robots/nobody/whereabouts?map=flat")
    assert (answer.status_code, answer.json()["type"]) == (404, "urn:topnav:problem:unknown_robot")
