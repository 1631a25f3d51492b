"""Visits are kept by place, the newest of them; they go with their map; damage is found and mended."""

import pytest
from sqlalchemy import update

from services.map_store.errors import InvalidError, MissingError
from services.map_store.inspections.store import InspectionStore
from services.map_store.integrity.check import check
from services.map_store.storage import tables
from shared.messages.inspections import Inspection, InspectionRequest, Region

CHANGE = Region(bearing_rad=0.5, elevation_rad=-0.25, width_rad=0.3, height_rad=0.4, score=0.02)


def visit(place="Door", round_number=1, mission_id="m-1", **facts):
    stamp_ns = facts.pop("stamp_ns", 1_000 + round_number)
    picture = f"picture of {place} in {mission_id}-{round_number}".encode()
    about = {"robot": "r1", "mission_id": mission_id, "round": round_number, "place": place}
    return Inspection(**about, stamp_ns=stamp_ns, picture=picture, **facts)


@pytest.fixture
def visits(store):
    return InspectionStore(store.database)


def last(visits, place="door", mission_id="m-1", round_number=0):
    about = InspectionRequest(action="last", place=place, mission_id=mission_id, round=round_number)
    return visits.answer("flat", about).inspection


def keep(visits, inspection, most=10):
    wish = InspectionRequest(action="save", place=inspection.place, inspection=inspection, keep=most)
    return visits.answer("flat", wish)


def test_the_last_visit_to_a_place_is_there_with_its_picture(visits):
    assert last(visits) is None
    for number in (1, 2):
        assert keep(visits, visit(round_number=number)).inspection.picture == b""
    keep(visits, visit("Bath", 3))
    assert last(visits) == visit(round_number=2)


def test_a_visit_made_again_takes_the_place_of_the_one_before_and_is_not_compared_with_it(visits):
    keep(visits, visit(round_number=1))
    keep(visits, visit(round_number=2))
    assert last(visits, round_number=2) == visit(round_number=1)
    keep(visits, visit(round_number=2, stamp_ns=5_000))
    assert [each.stamp_ns for (each,) in visits.rounds("flat")] == [5_000, 1_001]


def test_of_each_place_the_newest_stay(visits):
    for number in range(1, 6):
        keep(visits, visit("Door", number), most=2)
        keep(visits, visit("Bath", number), most=3)
    kept = [(each.place, each.round) for one in visits.rounds("flat") for each in one]
    assert kept == [("Door", 5), ("Bath", 5), ("Door", 4), ("Bath", 4), ("Bath", 3)]


def test_rounds_come_newest_first_without_pictures_and_one_round_with_them(visits):
    for place in ("Door", "Bath"):
        keep(visits, visit(place, 1))
    keep(visits, visit("Door", 1, "m-2", regions=(CHANGE,)))
    rounds = visits.rounds("flat")
    assert [[each.place for each in one] for one in rounds] == [["Door"], ["Door", "Bath"]]
    assert rounds[0][0].regions == (CHANGE,)
    assert {each.picture for one in rounds for each in one} == {b""}
    assert visits.round("flat", "m-1", 1) == [visit("Door"), visit("Bath")]
    assert visits.visit_at("flat", "DOOR", 1_001) == visit("Door", 1, "m-2", regions=(CHANGE,))
    with pytest.raises(MissingError, match="no round m-1-7"):
        visits.round("flat", "m-1", 7)


def test_visits_stay_with_a_map_renamed_and_go_with_one_deleted(store, visits):
    keep(visits, visit())
    store.rename("flat", "home")
    assert len(visits.rounds("home")) == 1
    store.delete("home")
    store.create("flat")
    assert visits.rounds("flat") == []


@pytest.mark.parametrize("column", ["content", "record", "round", "sha256"])
def test_a_damaged_visit_is_found_left_out_and_removed(store, visits, column):
    keep(visits, visit(round_number=1))
    keep(visits, visit(round_number=2))
    damage = {"content": b"?", "record": "{}", "round": 9, "sha256": "0" * 64}[column]
    with store.database.write() as connection:
        bad = tables.inspections.c.number == 2
        connection.execute(update(tables.inspections).where(bad).values({column: damage}))
    assert [each.thing for each in check(store.database)] == ["inspection 2"]
    assert last(visits) == visit(round_number=1)
    assert "1 inspections removed" in store.repair("flat").done
    assert check(store.database) == []


def test_an_inspection_of_another_place_is_refused(visits):
    with pytest.raises(InvalidError, match="save needs the inspection of 'Bath'"):
        visits.answer("flat", InspectionRequest(action="save", place="Bath", inspection=visit("Door")))
    with pytest.raises(MissingError):
        visits.answer("nowhere", InspectionRequest(action="last", place="Door"))
