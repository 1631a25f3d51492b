"""The table of transitions is whole, and the page that shows it is true."""

from pathlib import Path

import pytest

from services.planner.travel.states import MEANING, TRANSITIONS, Event, State

PAGE = Path(__file__).resolve().parents[5] / "deploy" / "TRAVEL.md"


def rows(header):
    """The rows of the page's table with these column heads."""
    lines = PAGE.read_text(encoding="utf-8").splitlines()
    start = lines.index(f"| {' | '.join(header)} |") + 2
    table = lines[start : lines.index("", start)]
    return [tuple(cell.strip().strip("`") for cell in line.strip("|").split(" | ")) for line in table]


def test_the_page_shows_the_states():
    assert rows(["state", "the robot"]) == [(state.value, meaning) for state, meaning in MEANING.items()]


def test_the_page_shows_every_transition_with_its_reason():
    expected = [(r.before.value, r.event.value, r.after.value, r.reason) for r in TRANSITIONS.values()]
    assert rows(["in", "event", "becomes", "because"]) == expected


def test_every_event_leads_somewhere_and_every_state_is_reached():
    assert {event for _, event in TRANSITIONS} == set(Event)
    assert {row.after for row in TRANSITIONS.values()} == set(State)
    assert set(MEANING) == set(State)


@pytest.mark.parametrize("state", [state for state in State if state is not State.FAILED])
def test_every_state_but_a_failure_can_be_left(state):
    assert any(before is state for before, _ in TRANSITIONS)


def test_a_failure_is_final():
    assert not any(before is State.FAILED for before, _ in TRANSITIONS)
