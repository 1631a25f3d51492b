"""`python -m tests.patient MODULE`: a service whose sessions outlive a pause of its process.

The bus gives up a process that says nothing for two seconds, with all questions on their way to it. That is
meant for services that hang, but a busy machine may hold up any process for as long.
"""

import runpy
import sys

from shared.transport import session_config as bus_config

LEASE_MS = 30_000


def main() -> None:
    """Run the module as if it were named in place of this one."""
    bus_config.LEASE_MS = LEASE_MS
    del sys.argv[0]
    runpy.run_module(sys.argv[0], run_name="__main__", alter_sys=True)


if __name__ == "__main__":
    main()
