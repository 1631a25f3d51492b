"""What a soak keeps: goes on where it was cut off, counts, and says what was done before a violation."""

import json
from dataclasses import asdict

import pytest

from experiments.soak.growth import Sample
from experiments.soak.journal import Journal
from services.launcher.client.failure import ExperimentError

SETUP = {"world": "apartment", "seed": 1}


def filled(path):
    journal = Journal(path, SETUP)
    journal.add("events", at_s=1.0, harm="kill", service="drive", healthy_after_s=2.5)
    journal.add("results", state="succeeded", failure="", steps=3)
    journal.add("results", state="failed", failure="lost", steps=3)
    journal.add("memory", **asdict(Sample("drive", 7, 2.0, 60.0)))
    journal.violation("no collision", "1 at (0, 0)")
    journal.writes(5)
    journal.write()
    return journal


def test_the_summary_counts_and_a_violation_names_what_was_done_before(tmp_path):
    journal = filled(tmp_path / "soak.json")
    told = journal.summary()
    assert (told["missions"], told["succeeded"], told["ends"]) == (2, 1, {"succeeded": 1, "lost": 1})
    assert (told["violations"], told["collisions"], told["acknowledged_writes"]) == (1, 1, 5)
    written = json.loads((tmp_path / "soak.json").read_text(encoding="utf-8"))
    assert written["violations"][0]["after"] == "kill drive at 1.0 s"
    assert written["summary"]["events"] == {"kill": 1}


def test_a_file_is_gone_on_with_and_its_time_counts(tmp_path):
    path = tmp_path / "soak.json"
    filled(path)
    content = json.loads(path.read_text(encoding="utf-8"))
    content["sessions"][0]["elapsed_s"] = 1800.0
    path.write_text(json.dumps(content), encoding="utf-8")
    again = Journal(path, SETUP)
    again.writes(4)
    told = again.summary()
    assert told["hours"] == pytest.approx(0.5, abs=0.01)
    assert (told["missions"], told["acknowledged_writes"]) == (2, 9)


def test_a_file_of_another_setup_is_refused(tmp_path):
    filled(tmp_path / "soak.json")
    with pytest.raises(ExperimentError, match="same options"):
        Journal(tmp_path / "soak.json", SETUP | {"seed": 2})
