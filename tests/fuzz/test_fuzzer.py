"""The fuzzer itself: faults put into a decoder on purpose are found, kept, and end nothing else."""

import json
import os
import subprocess
import sys
import time
from pathlib import Path

import pytest

from tests.fuzz.__main__ import main
from tests.fuzz.campaign import Campaign
from tests.fuzz.catalogue import chosen
from tests.fuzz.decoder import Decoder
from tests.fuzz.watch import Watch
from tests.fuzz.worker import Current, read_current

ROOT = Path(__file__).resolve().parents[2]


def number(data: bytes) -> int:
    """A decoder with one fault: the digit 7 is no error of its own."""
    if b"7" in data:
        raise KeyError("7")
    return int(data.decode("ascii"))


def decoder(decode: object, cpu_s: float = 60.0, memory_mb: int = 10_000) -> Decoder:
    """A decoder with limits so wide that nothing which goes on beside it in this process breaks them."""
    return Decoder("faulty/one", decode, (ValueError,), (b"123",), cpu_s=cpu_s, memory_mb=memory_mb)  # type: ignore[arg-type]


def test_another_error_than_the_documented_one_is_a_crash_and_kept(tmp_path: Path) -> None:
    current = Current(tmp_path)
    tally = Campaign(decoder(number), 1, tmp_path, current).run(3_000, None)
    assert tally.counts["accepted"] > 0
    assert tally.counts["refused"] > 0
    assert [crash.partition(" in ")[0] for crash in tally.crashes] == ["crash: KeyError"]
    files = sorted((tmp_path / "faulty/one").glob("*.bin"))
    assert 1 <= len(files) <= 3
    assert all(b"7" in file.read_bytes() for file in files)


def test_the_same_seed_gives_the_same_inputs(tmp_path: Path) -> None:
    def inputs(seed: int) -> list[bytes]:
        seen: list[bytes] = []
        Campaign(decoder(seen.append), seed, tmp_path, Current(tmp_path)).run(200, None)
        return seen

    assert inputs(5) == inputs(5)
    assert inputs(5) != inputs(6)


def slow(_data: bytes) -> None:
    """Take 0.2 s of processor time."""
    until_s = time.thread_time() + 0.2
    while time.thread_time() < until_s:
        pass


def hungry(_data: bytes) -> None:
    """Take 400 MB."""
    assert bytearray(os.urandom(1)) * 400_000_000


def told_of_limits() -> list[str]:
    """What becomes of too slow, too hungry, and of the same within limits."""
    watch = Watch()
    faulty = [decoder(slow, cpu_s=0.1), decoder(hungry, memory_mb=50), decoder(hungry, memory_mb=500)]
    return [watch.run(each, b"").kind for each in faulty]


def test_more_time_or_memory_than_allowed_is_told() -> None:
    """In a process of its own: what other tests left may be freed meanwhile here, and hide what is taken."""
    program = "import json; from tests.fuzz import test_fuzzer as it; print(json.dumps(it.told_of_limits()))"
    run = subprocess.run([sys.executable, "-c", program], cwd=ROOT, stdout=subprocess.PIPE, check=True)
    assert json.loads(run.stdout) == ["slow", "hungry", "accepted"]


@pytest.mark.parametrize("error", [SystemExit(1), RecursionError(), MemoryError(), AssertionError()])
def test_whatever_is_raised_is_a_crash(error: BaseException) -> None:
    def raising(_data: bytes) -> None:
        raise error

    outcome = Watch().run(decoder(raising), b"")
    assert outcome.bad
    assert type(error).__name__ in outcome.told


NOTING = """
import pathlib, signal, sys
from tests.fuzz import worker
worker.HANG_S = int(sys.argv[2])
worker.Current(pathlib.Path(sys.argv[1])).note(b"fatal")
"""


@pytest.mark.parametrize(
    ("fault", "hang_s", "ended"), [("signal.raise_signal(9)", 60, 9), ("signal.pause()", 1, 14)]
)
def test_the_input_that_ends_or_hangs_the_process_is_not_lost(
    tmp_path: Path, fault: str, hang_s: int, ended: int
) -> None:
    command = [sys.executable, "-c", NOTING + fault, str(tmp_path), str(hang_s)]
    assert subprocess.run(command, cwd=ROOT, timeout=120.0, check=False).returncode == -ended
    assert read_current(tmp_path) == b"fatal"


def test_an_unknown_decoder_is_named_with_those_there_are(capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(SystemExit) as ended:
        main(["--only", "recordings/tape"])
    assert ended.value.code == 2
    assert "recordings/read" in capsys.readouterr().err


def test_the_command_writes_its_report(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    report = tmp_path / "f.json"
    options = ["--executions=50", f"--keep={tmp_path / 'keep'}", f"--json={report}"]
    assert main(["--only=files/disturbance", *options]) == 0
    assert '"executions": 50' in report.read_text(encoding="utf-8")
    assert "| files/disturbance | 50 |" in capsys.readouterr().out


def test_a_family_has_a_decoder_for_every_kind_of_message(tmp_path: Path) -> None:
    from shared.messages import all_messages

    names = {one.name for one in chosen(["bus"], tmp_path)}
    assert {f"bus/{kind.SCHEMA}" for kind in all_messages()} <= names
