"""Tours read from disk: what is in them, and what their errors tell."""

import re

import numpy as np
import pytest

from experiments.photographs.tour_file import TourFile, kind_of
from experiments.photographs.tours import foreign_pairs, read_tour, read_tours
from services.launcher.client.failure import ExperimentError
from tests.readme import REPOSITORY, examples


def test_tours_are_found_in_a_folder_and_below(write_tour, tmp_path):
    write_tour("two")
    path = write_tour("one")
    assert [tour.file.name for tour in read_tours(tmp_path)] == ["one", "two"]
    (alone,) = read_tours(path.parent)
    assert [picture.name for picture in alone.paths] == ["a.png", "b.png", "c.png"]
    assert alone.links() == [(0, 1, 10.0)]
    assert alone.neighbours() == {0: {1}, 1: {0}}


def test_unlinked_pictures_of_different_rooms_of_a_kind_look_alike(write_tour):
    rooms = {"a": "room_1_bath", "b": "room_22_bath", "c": "room_3_bath"}
    assert read_tour(write_tour("baths", rooms=rooms)).look_alikes() == [(0, 2), (1, 2)]
    assert read_tour(write_tour("same", rooms={"a": "hall", "c": "hall"})).look_alikes() == []
    assert read_tour(write_tour("other", rooms={"a": "bath_1", "c": "room_2"})).look_alikes() == []
    assert kind_of("room_22_bath") == kind_of("room_1_bath") != kind_of("room_1")


LINK = {"from": "a", "to": "b", "bearing_deg": 1.0}


@pytest.mark.parametrize(
    ("fields", "told"),
    [
        (
            {"links": [LINK, LINK | {"to": "x"}]},
            r"links\.1\.to: expected an id of pictures \(a, b, c\), got 'x'",
        ),
        ({"links": [{"from": "a", "to": "b"}]}, r"links\.0\.bearing_deg: .*required, got nothing"),
        ({"links": [LINK | {"bearing_deg": "north"}]}, r"links\.0\.bearing_deg: .*number.*, got 'north'"),
        ({"links": [LINK | {"to": "a"}]}, r"links\.0: expected two pictures, got 'a' twice"),
        ({"rooms": {"z": "hall"}}, r"rooms\.z: expected an id of pictures"),
        ({"pictures": ["a", "b", "a"]}, r"pictures: expected ids that differ, got \['a'\] twice"),
        ({"pictures": ["a", "b", "c", "d"]}, r"pictures: expected d\.jpg or d\.png beside it for id 'd'"),
        ({"size_px": (64, 48)}, r"a\.png: expected .* twice as wide as high, got 64 x 48: export"),
    ],
)
def test_a_fault_is_told_with_its_file_and_place(write_tour, fields, told):
    path = write_tour(**fields)
    with pytest.raises(ExperimentError, match=told) as raised:
        read_tour(path)
    assert str(path.parent) in str(raised.value)


def test_what_is_no_json_and_no_picture_is_told(write_tour):
    path = write_tour("broken")
    path.write_text("{", encoding="utf-8")
    with pytest.raises(ExperimentError, match=re.escape(f"{path}: expected JSON")):
        read_tour(path)
    path = write_tour("text")
    (path.parent / "b.png").write_text("hello", encoding="utf-8")
    with pytest.raises(ExperimentError, match=r"b\.png: expected a JPEG or PNG picture"):
        read_tour(path)


def test_a_folder_without_tours_says_how_to_get_one(tmp_path):
    with pytest.raises(ExperimentError, match=r"expected a tour\.json .* found none: .*--render-example"):
        read_tours(tmp_path)


def test_foreign_pairs_are_all_or_so_many_and_never_of_one_tour():
    tour_of, rng = [0, 0, 1, 1, 1], np.random.default_rng(1)
    everything = foreign_pairs(tour_of, 10, rng)
    assert everything == [(a, b) for a in (0, 1) for b in (2, 3, 4)]
    some = foreign_pairs(tour_of, 4, rng)
    assert len(set(some)) == 4
    assert set(some) < set(everything)


def test_the_file_in_the_documentation_is_one():
    (shown,) = examples("json", REPOSITORY / "deploy" / "PHOTOGRAPHS.md")
    assert TourFile.model_validate_json(shown).links[1].bearing_deg == -12.5
