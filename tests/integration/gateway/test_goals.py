"""Goal pictures: through the gateway to the feature service and back."""

import io
import math

import httpx
import numpy as np
import pytest
from PIL import Image

from services.gateway.uploads import photo_places
from shared.mapgraph.local.hypotheses import COMPARED_NODES
from tests.integration.gateway.standins import FeatureService, Planner

pytestmark = pytest.mark.usefixtures("map_store")


def picture(kind: str = "PNG", width: int = 256) -> bytes:
    out = io.BytesIO()
    pixels = np.zeros((width // 2, width, 3), np.uint8)
    pixels[:, :, 0] = 200  # red
    Image.fromarray(pixels).save(out, kind)
    return out.getvalue()


@pytest.mark.parametrize("kind", ["PNG", "JPEG", "WEBP"])
def test_a_raw_picture_is_localised_best_node_first(
    http: httpx.Client, features: FeatureService, kind: str
) -> None:
    answer = http.post(
        "/api/robots/r1/goal-check?map=flat",
        content=picture(kind),
        headers={"content-type": f"image/{kind.lower()}"},
    )
    assert answer.status_code == 200, answer.text
    body = answer.json()
    assert body["verdict"] == "found"
    assert [node["node_id"] for node in body["nodes"]] == [7, 3]
    assert body["nodes"][0]["inliers"] == 71
    assert body["places"] == [{"nodes": [7], "similarity": 71, "support": 71}]
    assert body["nodes"][0]["heading_rad"] == 0.5
    assert body["picture"] == {"format": kind.lower(), "width_px": 256, "height_px": 128, "keypoints": 40}
    frame = features.extracted[-1].frame
    assert (frame.encoding, frame.width_px, frame.height_px) == ("bgr8", 256, 128)
    assert frame.data[2] > 190 > 20 > frame.data[0]  # red comes last
    question = features.matched[-1]
    assert (question.map, question.best_k, question.with_matches) == ("flat", COMPARED_NODES, False)
    assert question.features is not None


def test_places_that_look_alike_are_named_both(http: httpx.Client, features: FeatureService) -> None:
    before, seen = features.results, features.results[1]
    features.results = (seen, seen.model_copy(update={"node_id": 3, "inliers": 60}))
    try:
        answer = http.post(
            "/api/robots/r1/goal-check?map=flat", content=picture(), headers={"content-type": "image/png"}
        )
    finally:
        features.results = before
    body = answer.json()
    assert body["verdict"] == "ambiguous"
    assert [place["nodes"] for place in body["places"]] == [[7], [3]]


def test_what_resembles_no_node_is_not_found(http: httpx.Client, features: FeatureService) -> None:
    before, features.results = features.results, features.results[:1]
    try:
        answer = http.post(
            "/api/robots/r1/goal-check?map=flat", content=picture(), headers={"content-type": "image/png"}
        )
    finally:
        features.results = before
    assert (answer.json()["verdict"], answer.json()["places"]) == ("not_found", [])


def test_a_form_with_one_file_is_the_same(http: httpx.Client) -> None:
    answer = http.post(
        "/api/robots/r1/goal-check?map=flat", files={"picture": ("goal.png", picture(), "image/png")}
    )
    assert answer.status_code == 200, answer.text


def photo(width: int = 400, height: int = 300) -> bytes:
    out = io.BytesIO()
    Image.new("RGB", (width, height), (90, 120, 30)).save(out, "JPEG")
    return out.getvalue()


def test_an_ordinary_photo_is_asked_about_as_one_and_gets_a_typed_answer(
    http: httpx.Client, features: FeatureService
) -> None:
    answer = http.post(
        "/api/robots/r1/goal-check?map=flat&field_of_view_deg=70",
        content=photo(),
        headers={"content-type": "image/jpeg"},
    )
    assert answer.status_code == 200, answer.text
    body = answer.json()
    assert (body["verdict"], body["photo"]) == ("not_found", {"fov_known": True, "places": []})
    asked = features.photographed[-1].photo
    assert (asked.width_px, asked.height_px, asked.view.fov_known) == (400, 300, True)
    assert math.degrees(asked.view.fov_rad) == pytest.approx(70.0)
    question = features.matched[-1]
    assert question.features is not None
    assert question.features.photo == asked.view
    assert (question.best_k, question.with_matches) == (60, True)


def test_a_photo_waits_until_the_pictures_of_places_were_looked_at(
    http: httpx.Client, features: FeatureService, monkeypatch: pytest.MonkeyPatch
) -> None:
    url = "/api/robots/r1/goal-check?map=flat&field_of_view_deg=70"
    headers = {"content-type": "image/jpeg"}
    asked, features.busy = len(features.matched), 3
    assert http.post(url, content=photo(), headers=headers).status_code == 200
    assert len(features.matched) - asked == 4
    monkeypatch.setattr(photo_places, "LOOKING_S", 0.0)
    features.busy = 1
    refused = http.post(url, content=photo(), headers=headers)
    assert (refused.status_code, refused.json()["reason"]) == (409, "busy")


@pytest.mark.parametrize(
    ("size", "code"),
    [((300, 100), "not_two_to_one"), ((260, 180), "too_small"), ((1000, 502), "not_two_to_one")],
)
def test_what_is_neither_photo_nor_panorama_is_refused(
    http: httpx.Client, size: tuple[int, int], code: str
) -> None:
    headers = {"content-type": "image/jpeg"}
    answer = http.post("/api/robots/r1/goal-check?map=flat", content=photo(*size), headers=headers)
    assert (answer.status_code, answer.json()["type"].rpartition(":")[2]) == (422, code)


@pytest.mark.parametrize("told", ["0", "179", "nan", "wide"])
def test_a_field_of_view_that_no_photo_has_is_refused(http: httpx.Client, told: str) -> None:
    headers = {"content-type": "image/jpeg"}
    url = f"/api/robots/r1/goal-check?map=flat&field_of_view_deg={told}"
    assert http.post(url, content=photo(), headers=headers).status_code == 422


def test_a_photo_as_goal_reaches_the_planner_with_its_camera(http: httpx.Client, planner: Planner) -> None:
    answer = http.post(
        "/api/robots/r1/missions/goto?map=flat&field_of_view_deg=70",
        content=photo(),
        headers={"content-type": "image/jpeg"},
    )
    assert answer.status_code == 202, answer.text
    goal = planner.asked[-1].goal
    assert goal is not None
    assert goal.photo is not None
    assert goal.photo.fov_known
    planner.say(state="idle")


def test_large_pictures_reach_the_features_at_2048(http: httpx.Client, features: FeatureService) -> None:
    content = picture("PNG", 4096)
    answer = http.post(
        "/api/robots/r1/goal-check?map=flat", content=content, headers={"content-type": "image/png"}
    )
    assert answer.json()["picture"]["width_px"] == 4096
    assert features.extracted[-1].frame.width_px == 2048


def test_a_map_nobody_has_is_refused_in_the_services_words(http: httpx.Client) -> None:
    answer = http.post(
        "/api/robots/r1/goal-check?map=nowhere", content=picture(), headers={"content-type": "image/png"}
    )
    assert answer.status_code == 409
    assert answer.headers["content-type"] == "application/problem+json"
    assert "no map 'nowhere'" in answer.json()["detail"]


def test_goto_by_picture_hands_the_features_to_the_planner(http: httpx.Client, planner: Planner) -> None:
    answer = http.post(
        "/api/robots/r1/missions/goto?map=flat&seed=4",
        content=picture(),
        headers={"content-type": "image/png"},
    )
    assert answer.status_code == 202, answer.text
    assert (answer.json()["mission_id"], answer.json()["state"]) == ("m1", "running")
    wish = planner.asked[-1]
    assert (wish.action, wish.map, wish.seed) == ("goto", "flat", 4)
    assert wish.goal is not None
    assert wish.goal.pipeline == "standin/1"
