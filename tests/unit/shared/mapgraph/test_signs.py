"""Signs: found by number, joined from several nodes, the best one first; text from outside cleaned."""

import pytest
from pydantic import ValidationError

from shared.mapgraph.marks import by_key, only_nodes, renumbered, sign_called
from shared.mapgraph.signs import clean, joined
from shared.messages.places import SIGHTINGS_MAX, Sighting, Sign


def seen(node: int, height_rad: float = 0.1, confidence: float = 0.99) -> Sighting:
    return Sighting(node=node, bearing_rad=0.5, height_rad=height_rad, confidence=confidence)


def sign(name: str, *sightings: Sighting) -> Sign:
    return Sign(name=name, sightings=sightings)


SIGNS = by_key([sign("214", seen(1)), sign("216", seen(2)), sign("Lab B", seen(3))])


@pytest.mark.parametrize(
    ("text", "found"),
    [("214", "214"), ("room 214", "214"), ("Room  216 ", "216"), ("lab b", "Lab B")],
)
def test_a_sign_is_found_by_what_it_says_or_by_a_word_of_what_is_asked(text, found):
    assert sign_called(text, SIGNS) == SIGNS[found.casefold()]


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("215", "no sign '215'; nearest: '216', '214'"),
        ("21", "no sign '21'; nearest: '214', '216'"),
        ("214 or 216", "no sign '214 or 216'"),
        ("2\x1b14", "control characters"),
    ],
)
def test_what_no_sign_says_or_two_say_is_answered_with_the_nearest(text, words):
    assert words in str(sign_called(text, SIGNS))


def test_two_readings_are_one_sign_with_the_nearest_node_first_and_each_node_once():
    known = joined(sign("Lab", seen(1, 0.05), seen(2, 0.08)), sign("LAB", seen(2, 0.11), seen(3, 0.02)))
    assert known == sign("Lab", seen(2, 0.11), seen(1, 0.05), seen(3, 0.02))
    assert joined(known, sign("Lab", seen(2, 0.03))) == known
    assert joined(None, sign("x", seen(1, 0.1, 0.6), seen(2, 0.1, 0.9))).sightings[0].node == 2
    many = joined(known, sign("Lab", *(seen(n, 0.2) for n in range(10, 10 + SIGHTINGS_MAX))))
    assert len(many.sightings) == SIGHTINGS_MAX


def test_nodes_leave_and_are_renumbered_with_their_sightings():
    read = sign("214", seen(1), seen(2))
    assert only_nodes(read, {2}) == sign("214", seen(2))
    assert renumbered(read, {1: 7}, "214", {}) == sign("214", seen(7))


def test_text_is_cleaned_of_what_controls_and_hides_and_bounded():
    assert clean("\x1b 2\u202e1 \n 4\u200b ") == "21 4"
    assert clean("\uff12\uff11\uff14") == "214"
    assert clean("\x00\u2028") == ""
    assert len(clean("a " * 100)) <= 64


@pytest.mark.parametrize(
    "field", [{"height_rad": 0.0}, {"confidence": 1.5}, {"node": -1}, {"bearing_rad": 9.0}]
)
def test_a_sighting_that_cannot_be_is_refused(field):
    with pytest.raises(ValidationError):
        Sighting(**{"node": 1, "bearing_rad": 0.0, "height_rad": 0.1, "confidence": 0.9, **field})
