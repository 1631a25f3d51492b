"""`python -m shared.health SERVICE`: exit 0 when a process of that service is alive on the bus."""

import os
import sys
from pathlib import Path

from shared.access.credentials import CredentialsError
from shared.bus import UnreachableError, open_bus, wait_until


def main(arguments: list[str]) -> int:
    """Look for the service's liveliness token for up to two seconds."""
    if len(arguments) != 1:
        sys.stderr.write("usage: python -m shared.health SERVICE\n")
        return 2
    service = arguments[0]
    endpoint = os.environ.get("TOPNAV_ENDPOINT", "tcp/127.0.0.1:7447")
    certs = os.environ.get("TOPNAV_CERTS")
    try:
        with open_bus(endpoint, certs=Path(certs) if certs else None) as bus:
            alive = wait_until(lambda: bool(bus.alive(service)), timeout_s=2.0)
    except (CredentialsError, UnreachableError) as error:
        sys.stderr.write(f"{service}: {error}\n")
        return 1
    if not alive:
        sys.stderr.write(f"{service}: not alive on the bus\n")
    return 0 if alive else 1


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
