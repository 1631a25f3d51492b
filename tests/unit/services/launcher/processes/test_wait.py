"""Waiting for services: what is told meanwhile, and what is said when it was in vain."""

import json

import pytest

from services.launcher.processes import wait
from services.launcher.processes.runner import State
from services.launcher.processes.state import ServiceStatus
from services.launcher.processes.wait import LaunchError, require_healthy, waiting_for


def status(**states):
    return {name.replace("_", "-"): ServiceStatus(state=state, pid=1) for name, state in states.items()}


@pytest.fixture
def logs(tmp_path):
    line = json.dumps({"level": "INFO", "text": "45 models read, the last is chair.glb"})
    (tmp_path / "simulator.jsonl").write_text("{}\n" + line + "\n", encoding="utf-8")
    return tmp_path


def test_what_a_start_waits_for_is_told_with_the_last_word_of_it(logs, monkeypatch):
    monkeypatch.setattr(wait, "TELL_S", 0.0)
    told = []
    states = iter([State.STARTING, State.STARTING, State.HEALTHY])
    now = {"simulator": ServiceStatus(state=State.STARTING, pid=1)}

    def look():
        now["simulator"] = ServiceStatus(state=next(states), pid=1)
        return now

    require_healthy(look, ["simulator"], 5.0, logs, told=told.append)
    assert told == ["simulator (simulator: 45 models read, the last is chair.glb)"] * 2


def test_what_has_not_started_has_not_said_anything(logs):
    now = status(gateway=State.WAITING, simulator=State.STARTING)
    assert waiting_for(["gateway", "simulator"], now, logs).startswith("gateway, simulator (simulator: 45")
    assert waiting_for(["gateway"], now, logs) == "gateway"
    (logs / "simulator.jsonl").write_text("no JSON\n")
    assert waiting_for(["simulator"], now, logs) == "simulator"


def test_time_that_is_up_names_the_option_that_gives_more(logs):
    with pytest.raises(
        LaunchError, match=r"not healthy after 0 s: simulator starting.*--timeout-s gives it longer"
    ):
        require_healthy(lambda: status(simulator=State.STARTING), ["simulator"], 0.0, logs)
