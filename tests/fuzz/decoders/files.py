"""Settings, profiles and state that lie about as files and may be anybody's."""

import json
from pathlib import Path
from typing import Any

import yaml

from services.gateway.live.mission_log import read_missions
from services.gateway.routes.runs import list_runs
from services.launcher.compose.compose_file import COMPOSE_FILE, load_compose
from services.launcher.processes.stack_settings import profile_variables
from services.planner.profile_file import profile_of_file
from shared.estop.latch import UNREADABLE, Latch
from shared.messages.estop import EStopState
from simulator.disturbances.levels import Disturbances
from tests.fuzz.decoder import Decoder, Shape
from tests.fuzz.decoders.worlds import YAML_TOKENS, folded, unfolded

JSON_TOKENS = (
    b"NaN",
    b"Infinity",
    b"1e999",
    b"[" * 2000,
    b'{"a":' * 2000,
    b"\xed\xa0\x80",
    b'"\\ud800"',
    b"null",
)
PROFILE = {"base": "default", "thresholds": {"doorway_m": 1.5}, "measured": {"world": "flat", "pairs": 7}}
MISSION = {
    "robot": "r1", "mission_id": "m1", "kind": "explore", "map": "flat", "ended": "2026-01-01T00:00:00Z",
    "outcome": "succeeded",
}  # fmt: skip
RUN = {"command": "goto", "seed": 1, "ended": "2026-01-01T00:00:00Z", "figures": {"rounds": 3}}


def decoders(scratch: Path) -> list[Decoder]:
    """Each file with the error that its reader documents; logs and latches have none, they take anything."""
    shape = Shape(_from_json, _to_json)
    profile, state = _json(PROFILE), EStopState(robot="r1", engaged=True, who="me").model_dump_json().encode()
    return [
        Decoder("files/profile", _profile(scratch), (ValueError,), (profile,), JSON_TOKENS, shape),
        Decoder("files/compose", _compose(scratch), (ValueError,), (COMPOSE_FILE.read_bytes(), SMALL),
                (*YAML_TOKENS, b"${A:-b}", b"$", b"${"), Shape(unfolded, folded)),
        Decoder("files/estop", _estop(scratch), (), (state,), JSON_TOKENS, shape),
        Decoder("files/missions", _missions(scratch), (), (_json(MISSION) * 2,), JSON_TOKENS, shape),
        Decoder("files/run", _run(scratch), (), (_json(RUN),), JSON_TOKENS, shape),
        Decoder("files/disturbance", _disturbance, (ValueError,), (b"fog=0.5,noise=0.3", b"tilt=1"),
                (b"=", b",", b"nan", b"inf", b"1e-400", b"rain")),
    ]  # fmt: skip


SMALL = yaml.safe_dump({"services": {"a": {"command": ["python"], "environment": ["A=${B:-c}"]}}}).encode()


def _profile(scratch: Path) -> Any:
    file = scratch / "p.json"

    def run(data: bytes) -> None:
        file.write_bytes(data)
        profile_variables(str(file))
        profile_of_file(file)

    return run


def _compose(scratch: Path) -> Any:
    file = scratch / "c.yaml"

    def run(data: bytes) -> None:
        file.write_bytes(data)
        load_compose(file, {"TOPNAV_TOKEN": "x"})

    return run


def _estop(scratch: Path) -> Any:
    file = scratch / "estop-r1.json"

    def run(data: bytes) -> None:
        file.write_bytes(data)
        state = Latch("r1", scratch).state
        assert state.engaged or state.why != UNREADABLE, "what cannot be read must stop the robot"

    return run


def _missions(scratch: Path) -> Any:
    file = scratch / "missions.jsonl"

    def run(data: bytes) -> None:
        file.write_bytes(data)
        entries, broken = read_missions(file)
        assert len(entries) + broken >= 0

    return run


def _run(scratch: Path) -> Any:
    folder = scratch / "runs"
    folder.mkdir(parents=True, exist_ok=True)

    def run(data: bytes) -> None:
        (folder / "20260101T000000Z.json").write_bytes(data)
        found, broken = list_runs(folder, 10)
        assert len(found) + broken == 1
        assert all(entry.model_dump_json() for entry in found)

    return run


def _disturbance(data: bytes) -> None:
    levels = Disturbances.parse(data.decode("utf-8", "replace"))
    assert all(0.0 <= level <= 1.0 for _, level in levels)


def _json(content: Any) -> bytes:
    return json.dumps(content).encode() + b"\n"


def _from_json(data: bytes) -> Any:
    return json.loads(data)


def _to_json(tree: Any) -> bytes:
    return json.dumps(tree).encode()
