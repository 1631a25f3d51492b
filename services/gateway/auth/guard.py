"""Who sent a request and whether they may: every API request and WebSocket passes here first."""

import time
from dataclasses import dataclass
from typing import Annotated

from fastapi import Security
from fastapi.security import HTTPAuthorizationCredentials, HTTPBearer
from starlette.requests import HTTPConnection

from services.gateway.auth.roles import DRIVING, READS, UPLOADS, role_for
from services.gateway.auth.sessions import Sessions
from services.gateway.auth.tokens import ValidTokens
from services.gateway.http.rates import RateLimits, address_of
from services.gateway.settings import GatewaySettings
from shared.access.tokens import Role, Token, digest_of, includes
from shared.web.origins import LOOPBACK_NAMES, check_host, check_origin
from shared.web.problems import ProblemError

BEARER = HTTPBearer(auto_error=False, description="secret of a token, see `topnav token add`")
EVERYBODY = Token(role="admin", sha256="0" * 64)
"""Whoever comes while no token is set."""


@dataclass(frozen=True)
class Person:
    """Who sent a request.

    Attributes:
        token: theirs; None when they showed none and needed none.
        client: what their requests are counted by: a token's name or an address.
    """

    token: Token | None
    client: str

    @property
    def name(self) -> str:
        """The token's name; empty where there is none."""
        return self.token.name if self.token is not None else ""


class Access:
    """Tokens, sessions and rate limits of one gateway. Lives in the asyncio thread."""

    def __init__(self, settings: GatewaySettings, tokens: ValidTokens) -> None:
        self.settings, self.tokens = settings, tokens
        self.sessions, self.rates = Sessions(), RateLimits(settings)
        self.cookie = f"topnav_pass_{settings.port}"  # cookies are one host's, whatever the port

    def admit(self, connection: HTTPConnection, method: str, needed: Role | None) -> Person:
        """Let a request in that may be sent with role `needed`.

        Raises:
            ProblemError: 401 no valid token, 403 its role is too low, 429 too many wrong ones.
        """
        address = address_of(connection)
        if not self.tokens.required:
            return Person(EVERYBODY, address)
        free = needed is None or (method in READS and not self.settings.reading_guarded)
        token = self._token(connection, address, method, free)
        if needed is not None and not free:
            if token is None:
                raise _token_required("no token")
            if not includes(token.role, needed):
                raise _role_too_low(token, needed)
        return Person(token, f"token {token.name}" if token is not None and token.name else address)

    def holds(self, person: Person) -> bool:
        """Whether what let a person in is still valid."""
        return person.token in (None, EVERYBODY) or person.token in self.tokens

    def check_origins(self, connection: HTTPConnection, method: str) -> None:
        """Refuse foreign host names on loopback, and whatever writes or is a WebSocket from foreign pages.

        Raises:
            ProblemError: 403.
        """
        chosen = self.settings
        if chosen.loopback:
            hint = "use http://127.0.0.1 or add the name to GATEWAY_ALLOWED_HOSTS"
            check_host(connection, {*LOOPBACK_NAMES, chosen.host, *chosen.allowed_hosts}, hint)
        if method not in READS or connection.scope["type"] == "websocket":
            hint = "open the gateway's own page or add the origin to GATEWAY_ALLOWED_ORIGINS"
            check_origin(connection, chosen.allowed_origins, hint)

    def _token(self, connection: HTTPConnection, address: str, method: str, free: bool) -> Token | None:
        """The token in the header or, to read, that of a session; where all is `free` a wrong one is none."""
        scheme, _, sent = connection.headers.get("authorization", "").partition(" ")
        if not scheme:
            cookie = connection.cookies.get(self.cookie, "") if method in READS else ""
            return self.sessions.token_of(cookie, self.tokens.named, time.time())
        digest = digest_of(sent.strip())
        if not free:
            self.rates.before_token(address, digest)
        token = self.tokens.find(sent.strip()) if scheme.lower() == "bearer" else None
        if not free:
            self.rates.after_token(address, digest, token is not None)
            if token is None:
                raise _token_required("another token")
        return token


def access_of(connection: HTTPConnection) -> Access:
    """The application's `Access`."""
    access = connection.app.state.access
    assert isinstance(access, Access)
    return access


async def guard(
    connection: HTTPConnection,
    _shown: Annotated[HTTPAuthorizationCredentials | None, Security(BEARER)] = None,
) -> Person:
    """Dependency of every API route; counts what changes something.

    Raises:
        ProblemError: 403 foreign host or page or too low a role, 401 no token, 429 too often.
    """
    access = access_of(connection)
    method, path = str(connection.scope["method"]), str(connection.scope["route"].path)
    access.check_origins(connection, method)
    needed = role_for(method, path)
    stops = needed is None
    if stops and access.settings.estop_needs_token:
        needed = "viewer"
    person = access.admit(connection, method, needed)
    connection.state.person = person
    if (method, path) in DRIVING:
        access.rates.wish(person.client)
    elif method not in READS and not stops:  # a stop is never too many
        access.rates.write(person.client)
        if (method, path) in UPLOADS:
            access.rates.upload(person.client)
    return person


def admit_socket(connection: HTTPConnection) -> Person:
    """Let a WebSocket in: a page shows its session, a program the header.

    Raises:
        ProblemError: 403 foreign host or page, 401 no valid token, 429 too many wrong ones.
    """
    access = access_of(connection)
    access.check_origins(connection, "GET")
    return access.admit(connection, "GET", "viewer")


def person_of(connection: HTTPConnection) -> Person:
    """Who sent a request that `guard` let in."""
    person = connection.state.person
    assert isinstance(person, Person)
    return person


def _token_required(got: str) -> ProblemError:
    expected = "Authorization: Bearer with a token of this gateway"
    return ProblemError(
        401, "token_required", expected, got, "ask whoever runs the gateway for one (topnav token add)"
    )


def _role_too_low(token: Token, needed: Role) -> ProblemError:
    got = f"{token.role} (token {token.name})" if token.name else token.role
    expected, next_step = f"role {needed}", f"ask somebody who is {needed}"
    return ProblemError(403, "role_too_low", expected, got, next_step, needed=needed, role=token.role)
