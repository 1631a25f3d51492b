"""Names of places and rules: found, refused where they deceive, and carried to another map."""

import pytest
from pydantic import ValidationError

from shared.mapgraph.marks import by_key, free_names, nothing_called, place_called, renumbered, search
from shared.messages.places import NAME_MAX, KeepOut, Marks, OneWay, Place, checked_name, key_of

NAMES = ("Kitchen", "kitchenette", "Meeting room 2", "Room 214", "Dock")
PLACES = [Place(name=name, nodes=(number,)) for number, name in enumerate(NAMES)]


@pytest.mark.parametrize(
    ("text", "found"),
    [
        ("kitchen", ["Kitchen", "kitchenette"]),
        ("ROOM", ["Room 214", "Meeting room 2"]),
        ("214", ["Room 214"]),
        ("kichen", ["Kitchen", "kitchenette"]),
        ("  meeting   ROOM ", ["Meeting room 2"]),
        ("dôck", ["Dock"]),
        ("xyz", []),
    ],
)
def test_a_search_finds_names_that_begin_with_a_text_hold_it_or_are_like_it(text, found):
    assert [place.name for place in search(text, PLACES)][: len(found) or None] == found


def test_a_name_is_found_in_any_case_and_an_unknown_one_tells_the_nearest():
    places = by_key(PLACES)
    assert place_called("KITCHEN ", places) == PLACES[0]
    assert place_called("Dok", places) == "the map has no place 'Dok'; nearest: 'Dock'"
    assert "among others: 'Dock', 'Kitchen'" in str(place_called("zzzz", places))
    assert nothing_called("x", []) == "the map has no place 'x', and no places at all"
    assert "control characters" in str(place_called("a\x07", places))


@pytest.mark.parametrize(
    ("text", "kept"),
    [("  Küche ", "Küche"), ("Ku\u0308che", "Küche"), ("a\u00a0\u2003b", "a b"), ("部屋 2", "部屋 2")],
)
def test_names_are_kept_composed_and_with_single_spaces(text, kept):
    assert Place(name=text).name == kept
    assert key_of(text) == kept.casefold()


@pytest.mark.parametrize(
    "text", ["", "  ", "\t", "a\nb", "\x1b[2J", "\u202egnp.exe", "a\u200db", "\ufeffa", "x" * (NAME_MAX + 1)]
)
def test_names_that_are_empty_too_long_or_deceive_are_refused(text):
    with pytest.raises(ValidationError):
        Place(name=text)


def test_a_name_stands_once_among_places_and_once_among_rules():
    assert Marks(places=(Place(name="a"),), rules=(KeepOut(name="a"),))
    with pytest.raises(ValidationError, match="stands there twice"):
        Marks(places=(Place(name="Ää"), Place(name="ÄÄ")))


def test_marks_of_another_map_get_its_numbers_and_names_that_are_free():
    taken, new = by_key([Place(name="Dock"), Place(name="dock (wing)")]), by_key(PLACES)
    names = free_names(new, taken, "wing")
    assert names == {key: place.name for key, place in new.items()} | {"dock": "Dock (wing 2)"}
    rule = KeepOut(name="shut", nodes=(4, 9), areas=("DOCK", "kitchen"))
    assert renumbered(rule, {4: 14}, "shut", names) == KeepOut(
        name="shut", nodes=(14,), areas=("Dock (wing 2)", "Kitchen")
    )
    lane = OneWay(name="lane", edges=((4, 3), (4, 9)))
    assert renumbered(lane, {4: 14, 3: 20}, "lane", {}) == OneWay(name="lane", edges=((14, 20),))


def test_a_long_name_makes_room_for_that_of_the_map():
    long = "x" * NAME_MAX
    (name,) = free_names({long: Place(name=long)}, {long}, "m" * 64).values()
    assert len(name) == NAME_MAX
    assert checked_name(name) == name
