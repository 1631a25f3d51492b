"""Fuzz every decoder: `python -m tests.fuzz --seconds 60 [--only NAME]... --seed S --json F`.

Exits 1 when a decoder did anything but accept its input or refuse it with its own error within its limits.
What crashed it lies in --keep; `--again FILE --only NAME` executes one input.
"""

import argparse
import json
import subprocess
import sys
import tempfile
from pathlib import Path
from typing import Any

from tests.fuzz.campaign import keep_input
from tests.fuzz.catalogue import chosen
from tests.fuzz.watch import Watch
from tests.fuzz.worker import arguments, read_current

ROOT = Path(__file__).resolve().parents[2]
HEADINGS = ("decoder", "executions", "accepted", "refused", "ways", "crashes", "slowest ms", "most MB")
GRACE_S = 120.0


def fuzz(names: list[str], options: Any) -> list[dict[str, Any]]:
    """Run one worker over some decoders; a worker that dies leaves a tally with the crash that ended it."""
    told = [f"--{name}={getattr(options, name)}" for name in ("executions", "seconds", "seed", "keep")
            if getattr(options, name) is not None]  # fmt: skip
    command = [sys.executable, "-m", "tests.fuzz.worker", *names, *told]
    limit_s = None if options.seconds is None else len(names) * (options.seconds + GRACE_S)
    options.keep.mkdir(parents=True, exist_ok=True)
    errors = options.keep / "stderr.txt"
    with errors.open("w") as noise:  # libjpeg complains there about every damaged file
        run = subprocess.run(
            command, cwd=ROOT, stdout=subprocess.PIPE, stderr=noise, text=True, timeout=limit_s, check=False
        )
    lines = run.stdout.splitlines()
    tallies: list[dict[str, Any]] = [json.loads(line) for line in lines if line.startswith("{")]
    if run.returncode:
        died = next((line for line in reversed(lines) if not line.startswith("{")), names[0])
        why = f"crash: the process ended with {run.returncode}; {errors.read_text()[-300:].strip()}"
        keep_input(options.keep, died, read_current(options.keep), why)
        counts = {"crash": 1}
        tallies.append({"decoder": died, "executions": 0, "counts": counts, "ways": 0, "crashes": [why],
                        "slowest_s": 0.0, "hungriest_mb": 0.0, "seconds": 0.0})  # fmt: skip
    return tallies


def row(tally: dict[str, Any]) -> str:
    """One line of the table."""
    counts = tally["counts"]
    values = (
        tally["decoder"],
        tally["executions"],
        counts.get("accepted", 0),
        counts.get("refused", 0),
        tally["ways"],
        len(tally["crashes"]),
        round(1000 * tally["slowest_s"]),
        round(tally["hungriest_mb"]),
    )
    return "| " + " | ".join(str(value) for value in values) + " |"


def again(file: Path, names: list[str]) -> int:
    """Execute one kept input."""
    with tempfile.TemporaryDirectory(prefix="topnav-fuzz-") as scratch:
        outcomes = [Watch().run(decoder, file.read_bytes()) for decoder in chosen(names, Path(scratch))]
    for outcome in outcomes:
        say(f"{outcome.kind}: {outcome.told} ({outcome.cpu_s:.3f} s, {outcome.memory_mb:.1f} MB)")
    return int(any(outcome.bad for outcome in outcomes))


def say(line: str) -> None:
    """Write a line at once."""
    sys.stdout.write(line + "\n")
    sys.stdout.flush()


def main(given: list[str]) -> int:
    """Parse, fuzz, report."""
    parser = argparse.ArgumentParser(prog="python -m tests.fuzz", description=__doc__)
    arguments(parser)
    parser.add_argument("--only", action="append", default=[], help="a decoder or a family; again for more")
    parser.add_argument("--json", type=Path, default=None, help="file for the report")
    parser.add_argument("--again", type=Path, default=None, help="execute this input only")
    options: Any = parser.parse_args(given)
    if options.executions is None and options.seconds is None:
        options.seconds = 60.0
    options.keep = options.keep.absolute()
    try:
        with tempfile.TemporaryDirectory(prefix="topnav-fuzz-") as scratch:
            names = [decoder.name for decoder in chosen(options.only, Path(scratch))]
    except ValueError as error:
        parser.error(str(error))
    if options.again is not None:
        return again(options.again, names)
    say("| " + " | ".join(HEADINGS) + " |\n|" + "---|" * len(HEADINGS))
    tallies = []
    for name in names:  # a process each: what one leaves behind shall not count against the next
        for tally in fuzz([name], options):
            tallies.append(tally)
            say(row(tally))
    if options.json is not None:
        report = {"seed": options.seed, "seconds": options.seconds, "decoders": tallies}
        options.json.parent.mkdir(parents=True, exist_ok=True)
        options.json.write_text(json.dumps(report, indent=2) + "\n", encoding="utf-8")
    crashes = [f"{tally['decoder']}: {crash}" for tally in tallies for crash in tally["crashes"]]
    for crash in crashes:
        say(crash)
    executions = sum(tally["executions"] for tally in tallies)
    say(
        f"{executions} executions of {len(names)} decoders, {len(crashes)} kinds of crash; "
        f"inputs are kept in {options.keep}"
    )
    return int(bool(crashes))


if __name__ == "__main__":
    raise SystemExit(main(sys.argv[1:]))
