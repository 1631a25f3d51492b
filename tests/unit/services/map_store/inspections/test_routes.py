"""Rounds over REST, and the page of a round: both pictures turned alike, with boxes round what changed."""

import math
import re

import pytest
from fastapi.testclient import TestClient

from services.map_store.inspections.store import InspectionStore
from shared.messages.inspections import Inspection, Region
from tests.unit.services.map_store.conftest import app_of

AHEAD = Region(bearing_rad=0.0, elevation_rad=0.0, width_rad=0.2, height_rad=0.1, score=0.02)
BEHIND = Region(bearing_rad=math.pi, elevation_rad=0.2, width_rad=0.2, height_rad=0.1, score=0.01)


def visit(number, place="Door", **facts):
    about = {"robot": "r1", "mission_id": "m-1", "round": number, "place": place}
    return Inspection(**about, stamp_ns=number * 10**18, picture=b"jpeg %d" % number, **facts)


@pytest.fixture
def client(store):
    visits = InspectionStore(store.database)
    visits.save("flat", visit(1, why="no earlier picture"), 10)
    found = {"against_ns": 10**18, "yaw_rad": math.pi / 2, "regions": (AHEAD, BEHIND), "inliers": 80}
    visits.save("flat", visit(2, **found), 10)
    visits.save("flat", visit(2, '<b>&"', against_ns=10**18, yaw_rad=0.0), 10)
    return TestClient(app_of(store), raise_server_exceptions=False)


def test_rounds_are_listed_with_what_changed(client):
    second, first = client.get("/maps/flat/inspections").json()
    assert (second["round"], second["changes"], len(second["visits"])) == ("m-1-2", 2, 2)
    assert (first["round"], first["changes"]) == ("m-1-1", 0)
    assert first["visits"][0]["why"] == "no earlier picture"
    assert client.get("/maps/flat/inspections/m-1-2").json() == second
    assert second["visits"][0]["changes"][0] == AHEAD.model_dump()


@pytest.mark.parametrize(
    ("path", "status"),
    [
        ("/maps/flat/inspections/m-1-9", 404),
        ("/maps/nowhere/inspections", 404),
        ("/maps/flat/inspections/nonsense", 422),
        ("/maps/flat/inspections/m-1-9/report", 404),
        ("/maps/flat/inspections/m-1-9/picture?place=Door", 404),
        ("/maps/flat/inspections/m-1-2/picture?place=Bath", 404),
        ("/maps/flat/inspections/m-1-1/picture?place=Door&before=true", 404),
        ("/maps/flat/inspections/m-1-2/picture", 422),
    ],
)
def test_what_is_not_there_is_a_problem(client, path, status):
    assert client.get(path).status_code == status


def test_the_page_shows_both_pictures_turned_alike(client):
    answer = client.get("/maps/flat/inspections/m-1-2/report")
    assert answer.headers["content-type"].startswith("text/html")
    images = re.findall(r'<image id="(\w+)-\d+" x="(\d+)"', answer.text)
    assert images[:2] == [("before", "250"), ("now", "0")]
    assert 'x="-1000"/>' in answer.text
    assert "style" not in answer.text
    assert "<script" not in answer.text


def test_the_page_marks_what_changed_also_across_the_seam(client):
    page = client.get("/maps/flat/inspections/m-1-2/report").text
    boxes = re.findall(r'<rect x="(-?\d+)" y="(\d+)" width="(\d+)"', page.split("now, ")[1])
    assert boxes == [("484", "242", "32"), ("-16", "210", "32"), ("984", "210", "32")]
    assert "2 places, 2 changes" in page


def test_names_of_places_are_text_and_nothing_else(client):
    page = client.get("/maps/flat/inspections/m-1-2/report").text
    assert "&lt;b&gt;&amp;&quot;" in page
    assert "<b>" not in page


def test_a_visit_whose_earlier_picture_is_forgotten_shows_its_own(store, client):
    InspectionStore(store.database).save("flat", visit(3, against_ns=5, yaw_rad=0.1), 10)
    page = client.get("/maps/flat/inspections/m-1-3/report").text
    assert re.findall(r'<image id="(\w+)-', page) == ["now"]


def test_both_pictures_of_a_place_are_there_one_by_one(client):
    url = "/maps/flat/inspections/m-1-2/picture"
    now = client.get(url, params={"place": "door"})
    assert (now.content, now.headers["content-type"]) == (b"jpeg 2", "image/jpeg")
    assert client.get(url, params={"place": "Door", "before": True}).content == b"jpeg 1"
