"""`python -m tests.faults.durability`: nothing acknowledged is lost, no changed byte in use goes unnoticed.

--kills N   SIGKILL the map store N times at random instants under load
--flips N   change one random byte in each of N copies of a database; tells how many were in use and found
"""

import argparse
import json
import logging
import sys
import tempfile
from pathlib import Path
from typing import Any

import zenoh

from services.launcher.processes.free_ports import free_ports
from shared.transport.router_config import router_config
from tests.faults.flips import figures, flips
from tests.faults.kills import Report, kill_often

REPOSITORY = Path(__file__).resolve().parents[2]


def main(arguments: list[str] | None = None) -> int:
    """Run what is asked for, print the figures; 1 when something was lost or went unnoticed."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawTextHelpFormatter)
    parser.add_argument("--kills", type=int, default=0)
    parser.add_argument("--flips", type=int, default=0)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--json", type=Path, help="write the figures to this file")
    chosen = parser.parse_args(arguments)
    logging.getLogger().setLevel(logging.CRITICAL)
    result: dict[str, Any] = {"seed": chosen.seed}
    with tempfile.TemporaryDirectory() as folder:
        if chosen.kills:
            result["kills"] = _kills(Path(folder), chosen.kills, chosen.seed).figures()
        if chosen.flips:
            found = list(flips(Path(folder), chosen.flips, chosen.seed))
            result["flips"] = figures(found) | {"each": [vars(flip) for flip in found]}
    text = json.dumps(result, indent=1)
    if chosen.json:
        chosen.json.write_text(text, encoding="utf-8")
    _say({name: _short(part) if isinstance(part, dict) else part for name, part in result.items()})
    kills, flipped = result.get("kills", {}), result.get("flips", {})
    return int(bool(kills.get("wrong") or flipped.get("undetected")))


def _kills(folder: Path, kills: int, seed: int) -> Report:
    bus_port, rest_port = free_ports(2)
    endpoint = f"tcp/127.0.0.1:{bus_port}"

    def tell(report: Report) -> None:
        _say({"kills": report.kills, "acknowledged": report.acknowledged, "wrong": report.wrong[:3]})

    with zenoh.open(router_config(endpoint)):
        return kill_often(folder, REPOSITORY, endpoint, rest_port, kills, seed, tell=tell)


def _short(part: dict[str, Any]) -> dict[str, Any]:
    return {name: value for name, value in part.items() if name not in ("each", "recovery_s")}


def _say(figures: dict[str, Any]) -> None:
    sys.stderr.write(json.dumps(figures) + "\n")


if __name__ == "__main__":
    raise SystemExit(main())
