"""Which names lead to a server, which pages may speak to it: against DNS rebinding and forged requests."""

import ipaddress
from collections.abc import Collection
from urllib.parse import SplitResult, urlsplit

from starlette.requests import HTTPConnection

from shared.web.problems import ProblemError

LOOPBACK_NAMES = frozenset({"127.0.0.1", "localhost", "::1"})


def is_loopback(host: str) -> bool:
    """Whether only this machine can connect to what listens on `host`."""
    if host == "localhost":
        return True
    try:
        return ipaddress.ip_address(host).is_loopback
    except ValueError:
        return False


def check_host(connection: HTTPConnection, names: Collection[str], next_step: str) -> None:
    """Refuse requests by another name than one of `names`; on loopback a foreign one is DNS rebinding.

    Raises:
        ProblemError: 403.
    """
    host = connection.headers.get("host", "")
    if _parts(f"//{host}").hostname not in names:
        expected = f"one of {sorted(names)} as Host"
        raise ProblemError(403, "foreign_host", expected, host[:80] or "none", next_step)


def check_origin(connection: HTTPConnection, allowed: Collection[str], next_step: str) -> None:
    """Refuse pages of other sites; programs send no Origin and pass.

    Raises:
        ProblemError: 403.
    """
    origin = connection.headers.get("origin")
    if origin is None or origin in allowed:
        return
    if (
        _parts(origin).netloc.lower() != connection.headers.get("host", "").lower()
        or not _parts(origin).netloc
    ):
        raise ProblemError(403, "foreign_origin", "a page of this server", origin[:80], next_step)


def _parts(url: str) -> SplitResult:
    """Of a URL; empty ones of what is none."""
    try:
        return urlsplit(url)
    except ValueError:
        return urlsplit("")
