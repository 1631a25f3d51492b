"""Who may do what: host names, origins of web pages, and the token for writes."""

import hmac
from urllib.parse import urlsplit

from starlette.requests import HTTPConnection

from services.gateway.problems import ProblemError
from services.gateway.settings import GatewaySettings
from services.gateway.state import GatewayDep

READS = frozenset({"GET", "HEAD", "OPTIONS"})
LOOPBACK_NAMES = frozenset({"127.0.0.1", "localhost", "::1"})


def guard(connection: HTTPConnection, gateway: GatewayDep) -> None:
    """Dependency of every API route.

    Raises:
        ProblemError: 403 foreign host or page, 401 a write without the token.
    """
    settings = gateway.settings
    check_host(connection, settings)
    if connection.scope.get("method") in READS:
        return
    check_origin(connection, settings)
    if connection.scope["type"] == "http":
        _check_token(connection, settings)


def check_host(connection: HTTPConnection, settings: GatewaySettings) -> None:
    """On loopback, answer only to this machine's names: a foreign one here is DNS rebinding."""
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
    """Refuse pages of other sites; programs send no Origin and pass."""
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


def _check_token(connection: HTTPConnection, settings: GatewaySettings) -> None:
    token = settings.token.get_secret_value()
    if not token:
        return
    scheme, _, sent = connection.headers.get("authorization", "").partition(" ")
    if scheme.lower() != "bearer" or not hmac.compare_digest(sent.strip().encode(), token.encode()):
        raise ProblemError(
            401,
            "token_required",
            expected="Authorization: Bearer with the gateway's token",
            got="another token" if sent else "no token",
            next_step="ask whoever set GATEWAY_TOKEN",
        )


def _parses(url: str) -> bool:
    try:
        return bool(urlsplit(url).netloc)
    except ValueError:
        return False
