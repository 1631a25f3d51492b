"""Every mission that ends is told once, whatever the planner repeats and whoever restarts."""

from datetime import UTC, datetime, timedelta

import pytest

from services.gateway.live.mission_watch import MissionEntry, MissionWatch
from shared.messages.missions import EventValue, MissionStatus

START = datetime(2026, 3, 1, 12, 0, tzinfo=UTC)


def status(state: str, mission_id: str = "m1", **changes: object) -> MissionStatus:
    facts = {"robot": "r1", "action": "explore", "map": "flat", **changes}
    return MissionStatus(mission_id=mission_id, state=state, **facts)  # type: ignore[arg-type]


def told(watch: MissionWatch, *statuses: MissionStatus) -> list[MissionEntry]:
    """What is news when these come a second apart."""
    entries = [watch.take(one, START + timedelta(seconds=n)) for n, one in enumerate(statuses)]
    return [entry for entry in entries if entry is not None]


def test_an_end_is_told_with_its_times_and_figures() -> None:
    figures = {"nodes": 9, "edges": 8, "open_directions": 2, "similarity": 70, "reason": "all seen"}
    (entry,) = told(
        MissionWatch(), status("running"), status("paused"), status("succeeded", step=40, **figures)
    )
    assert (entry.kind, entry.map, entry.outcome, entry.steps) == ("explore", "flat", "succeeded", 40)
    assert (entry.started, entry.ended) == (START, START + timedelta(seconds=2))
    assert entry.model_dump(include=figures.keys()) == figures


def test_a_repeated_end_is_no_news() -> None:
    assert len(told(MissionWatch(), status("running"), *[status("failed")] * 5)) == 1


def test_what_is_on_record_from_before_a_restart_is_no_news() -> None:
    watch = MissionWatch()
    watch.know({("r1", "m1")})
    assert told(watch, status("succeeded")) == []


def test_an_end_that_came_while_nobody_listened_is_told_without_a_start() -> None:
    entries = told(MissionWatch(), status("succeeded"), status("failed", robot="r2"))
    assert [(entry.robot, entry.started) for entry in entries] == [("r1", None), ("r2", None)]


def test_a_refused_start_does_not_count_as_a_mission_with_the_outcome_of_the_one_before() -> None:
    entries = told(MissionWatch(), status("running"), status("succeeded"), status("succeeded", "refused"))
    assert [entry.mission_id for entry in entries] == ["m1"]


def test_the_next_mission_is_told_and_robots_are_told_apart() -> None:
    ways = [("running", "m1", "r1"), ("running", "m1", "r2"), ("cancelled", "m1", "r1")]
    ways += [("running", "m2", "r1"), ("failed", "m2", "r1"), ("succeeded", "m1", "r2")]
    entries = told(MissionWatch(), *(status(state, name, robot=robot) for state, name, robot in ways))
    assert [(e.robot, e.mission_id, e.outcome) for e in entries] == [
        ("r1", "m1", "cancelled"),
        ("r1", "m2", "failed"),
        ("r2", "m1", "succeeded"),
    ]


def test_the_seed_is_told_of_the_mission_it_belongs_to_only() -> None:
    watch = MissionWatch()
    watch.ordered("r1", "m1", 7)
    entries = told(
        watch, status("running"), status("failed"), status("running", "m2"), status("failed", "m2")
    )
    assert [entry.seed for entry in entries] == [7, None]


def test_a_mission_of_any_kind_is_told_with_the_figures_that_its_kind_shows() -> None:
    figures = (EventValue(name="places_seen", value=4), EventValue(name="changes", value=None))
    (entry,) = told(
        MissionWatch(),
        status("running", action="patrol"),
        status("succeeded", action="patrol", figures=figures),
    )
    assert (entry.kind, entry.figures) == ("patrol", {"places_seen": 4})


@pytest.mark.parametrize("changes", [{"mission_id": ""}, {"mission_id": "x" * 65}, {"action": ""}])
def test_what_is_no_mission_is_left_out(changes: dict[str, str]) -> None:
    strange = {"mission_id": "m1", **changes}
    assert told(MissionWatch(), status("running", **strange), status("succeeded", **strange)) == []
