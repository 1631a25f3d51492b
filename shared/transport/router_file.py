"""`python -m shared.transport.router_file`: write deploy/zenoh/router-secure.json5, for a stock `zenohd`."""

import json
import sys
from pathlib import Path
from typing import Any

import zenoh

from shared.access.credentials import FILES, Credentials
from shared.transport.router_config import secured_router_config

PATH = Path("deploy/zenoh/router-secure.json5")
CERTS = Path("/run/topnav/certs")
ROBOTS = ("r1",)
LISTEN = "tls/0.0.0.0:7447"
HEADER = """\
// Router of the secured profile for a stock `zenohd` 1.10 and robot r1, as `python -m shared.router` runs it.
// Written by `python -m shared.transport.router_file`; tests/contract compares them.
// It expects the router's own folder of `topnav certs` at /run/topnav/certs.
"""
SECTIONS = ("mode", "listen", "connect", "scouting", "timestamping", "transport")


def router_config_of_the_file() -> zenoh.Config:
    """What the file must mean."""
    return secured_router_config(LISTEN, Credentials(*(CERTS / name for name in FILES)), ROBOTS)


def router_file() -> str:
    """The whole file: where it differs from a router without settings, and every access rule on a line."""
    ours, plain = router_config_of_the_file(), zenoh.Config()
    lines = []
    for name in SECTIONS:
        section = _difference(json.loads(ours.get_json(name)), json.loads(plain.get_json(name)))
        lines.append(f"{json.dumps(name)}: {json.dumps(section)}")
    rules = json.loads(ours.get_json("access_control"))
    parts = [f"{json.dumps(name)}: {_listed(value)}" for name, value in rules.items()]
    lines.append('"access_control": {\n    ' + ",\n    ".join(parts) + "\n  }")
    return HEADER + "{\n  " + ",\n  ".join(lines) + "\n}\n"


def _difference(node: Any, plain: Any) -> Any:
    if not isinstance(node, dict) or not isinstance(plain, dict):
        return node
    return {k: _difference(v, plain.get(k)) for k, v in node.items() if v is not None and v != plain.get(k)}


def _listed(value: Any) -> str:
    if not isinstance(value, list):
        return json.dumps(value)
    rows = (json.dumps({k: v for k, v in row.items() if v is not None}) for row in value)
    return "[\n      " + ",\n      ".join(rows) + "\n    ]"


if __name__ == "__main__":
    PATH.write_text(router_file(), encoding="utf-8")
    sys.stdout.write(f"{PATH}\n")
