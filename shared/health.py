"""`python -m shared.health SERVICE`: exit 0 when a process of that service is alive on the bus.

It runs every few seconds in every container, so it imports neither messages nor pydantic.
"""

import os
import sys
import time
from pathlib import Path

import zenoh

from shared.access.credentials import CredentialsError, credentials_in
from shared.transport.keys import alive_key
from shared.transport.session_config import client_config, looker_config

PATIENCE_S = 2.0
"""Chosen: the router may not have heard of a token that is just declared."""


def main(arguments: list[str]) -> int:
    """Look for the service's liveliness token for up to two seconds."""
    if len(arguments) != 1:
        sys.stderr.write("usage: python -m shared.health SERVICE\n")
        return 2
    service = arguments[0]
    try:
        alive = _is_alive(service)
    except (CredentialsError, zenoh.ZError) as error:
        sys.stderr.write(f"{service}: {error}\n")
        return 1
    if not alive:
        sys.stderr.write(f"{service}: not alive on the bus\n")
    return 0 if alive else 1


def _is_alive(service: str) -> bool:
    endpoint, certs = os.environ.get("TOPNAV_ENDPOINT", "tcp/127.0.0.1:7447"), os.environ.get("TOPNAV_CERTS")
    credentials = credentials_in(Path(certs) if certs else None)
    config = client_config(endpoint, credentials) if credentials else looker_config(endpoint)
    session, until_s = zenoh.open(config), time.monotonic() + PATIENCE_S
    try:
        while time.monotonic() < until_s:
            answers = session.liveliness().get(alive_key(service, "*"), timeout=PATIENCE_S)
            if any(answer.ok is not None for answer in answers):
                return True
            time.sleep(0.1)
    finally:
        session.close()  # type: ignore[no-untyped-call]
    return False


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
