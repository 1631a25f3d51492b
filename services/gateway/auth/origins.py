"""Which names lead here and which web pages may speak: against DNS rebinding and forged requests."""

from urllib.parse import urlsplit

from starlette.requests import HTTPConnection

from services.gateway.http.problems import ProblemError
from services.gateway.settings import GatewaySettings

LOOPBACK_NAMES = frozenset({"127.0.0.1", "localhost", "::1"})


def check_host(connection: HTTPConnection, settings: GatewaySettings) -> None:
    """On loopback, answer only to this machine's names: a foreign one here is DNS rebinding.

    Raises:
        ProblemError: 403.
    """
    host = connection.headers.get("host", "")
    name = urlsplit(f"//{host}").hostname if _parses(f"//{host}") else None
    if settings.loopback and name not in {*LOOPBACK_NAMES, settings.host, *settings.allowed_hosts}:
        raise ProblemError(
            403,
            "foreign_host",
            expected=f"one of {sorted(LOOPBACK_NAMES)} as Host",
            got=host[:80] or "none",
            next_step="use http://127.0.0.1 or add the name to GATEWAY_ALLOWED_HOSTS",
        )


def check_origin(connection: HTTPConnection, settings: GatewaySettings) -> None:
    """Refuse pages of other sites; programs send no Origin and pass.

    Raises:
        ProblemError: 403.
    """
    origin = connection.headers.get("origin")
    if origin is None or origin in settings.allowed_origins:
        return
    if not _parses(origin) or urlsplit(origin).netloc.lower() != connection.headers.get("host", "").lower():
        raise ProblemError(
            403,
            "foreign_origin",
            expected="a page of this gateway",
            got=origin[:80],
            next_step="open the gateway's own page or add the origin to GATEWAY_ALLOWED_ORIGINS",
        )


def _parses(url: str) -> bool:
    try:
        return bool(urlsplit(url).netloc)
    except ValueError:
        return False
