"""The certificates of a secured stack: made before its first start, looked at before each."""

import datetime as dt
from collections.abc import Sequence
from pathlib import Path

from services.launcher.processes.wait import LaunchError

OPERATOR = "operator"
"""Whose certificate the shell and the launcher's own watch use."""


def prepare(folder: Path, robots: Sequence[str]) -> None:
    """Make the certificates that are missing in `folder`.

    Raises:
        LaunchError: one that is there has expired or does not fit.
    """
    # Only a secured stack needs the library behind these.
    from shared.certificates.checking import check
    from shared.certificates.holders import everyone
    from shared.certificates.issuing import make

    now = dt.datetime.now(dt.UTC)
    make(folder, everyone(*robots), now, keep=True)
    for finding in check(folder, now):
        if finding.faults:
            raise LaunchError(f"certificate of {finding.name}: {finding.faults[0]}")
