"""`python -m shared.certificates FOLDER`: make what is missing there; the one-shot service of Docker Compose.

TOPNAV_ROUTER_HOST is a further name or address at which the router is reached. `topnav certs` can do more.
"""

import datetime as dt
import os
import sys
from pathlib import Path

from shared.access.rules import robot_names
from shared.certificates.holders import everyone
from shared.certificates.issuing import make


def main(arguments: list[str]) -> int:
    """Make missing certificates; 1 with one line when that fails."""
    if len(arguments) != 1:
        sys.stderr.write("usage: python -m shared.certificates FOLDER\n")
        return 2
    try:
        holders = everyone(*robot_names(os.environ))
        hosts = tuple(host for host in [os.environ.get("TOPNAV_ROUTER_HOST")] if host)
        made = make(Path(arguments[0]), holders, dt.datetime.now(dt.UTC), hosts, keep=True)
    except (ValueError, OSError) as error:
        sys.stderr.write(f"certificates: {error}\n")
        return 1
    sys.stdout.write(f"{len(made)} made, {len(holders) - len(made)} kept in {arguments[0]}\n")
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
