"""Who may do what: tokens, passes and roles."""

import time
from dataclasses import dataclass

from starlette.requests import HTTPConnection

from services.gateway.auth.book import TokenBook
from services.gateway.auth.passes import Passes
from services.gateway.auth.rules import READS
from services.gateway.http.limits import Limits, address_of
from services.gateway.http.problems import ProblemError
from services.gateway.settings import GatewaySettings
from shared.access.roles import Role, includes
from shared.access.token import Token, digest_of

EVERYBODY = Token(role="admin", sha256="0" * 64)
"""Whoever comes while no token is set."""


@dataclass(frozen=True)
class Person:
    """Who sent a request.

    Attributes:
        token: theirs; None when they showed none and needed none.
        client: what their requests are counted by.
    """

    token: Token | None
    client: str

    @property
    def name(self) -> str:
        """The token's name; empty where there is none."""
        return self.token.name if self.token is not None else ""


class Access:
    """Tokens, passes and rate limits of one gateway. Lives in the asyncio thread."""

    def __init__(self, settings: GatewaySettings, book: TokenBook) -> None:
        self.settings, self.book = settings, book
        self.passes, self.limits = Passes(), Limits(settings)
        self.cookie = f"topnav_pass_{settings.port}"  # cookies are one host's, whatever the port

    def admit(self, connection: HTTPConnection, method: str, needed: Role | None) -> Person:
        """Let a request in that may be sent with role `needed`.

        Raises:
            ProblemError: 401 no valid token, 403 its role is too low, 429 too many wrong ones.
        """
        address = address_of(connection)
        if not self.book.guards:
            return Person(EVERYBODY, address)
        free = method in READS and not self.settings.reading_guarded
        token = self._token(connection, address, method, lenient=needed is None or free)
        if needed is None or free:
            return Person(token, _client(address, token))
        if token is None:
            raise _token_required(sent=False)
        if not includes(token.role, needed):
            raise _role_too_low(token, needed)
        return Person(token, _client(address, token))

    def holds(self, person: Person) -> bool:
        """Whether what let a person in is still valid."""
        return person.token in (None, EVERYBODY) or self.book.holds(person.token)

    def _token(self, connection: HTTPConnection, address: str, method: str, lenient: bool) -> Token | None:
        """The token in the header or, to read, that of a pass; `lenient` takes a wrong one for none."""
        scheme, _, sent = connection.headers.get("authorization", "").partition(" ")
        if not scheme:
            return self._of_pass(connection) if method in READS else None
        digest = digest_of(sent.strip())
        if not lenient:
            self.limits.before_token(address, digest)
        token = self.book.find(sent.strip()) if scheme.lower() == "bearer" else None
        if not lenient:
            self.limits.after_token(address, digest, token is not None)
        if token is None and not lenient:
            raise _token_required(sent=True)
        return token

    def _of_pass(self, connection: HTTPConnection) -> Token | None:
        value = connection.cookies.get(self.cookie, "")
        name = self.passes.name_of(value)
        token = None if name is None else self.book.named(name)
        return token if token is not None and self.passes.good(value, token, time.time()) else None


def _client(address: str, token: Token | None) -> str:
    return f"token {token.name}" if token is not None and token.name else address


def _token_required(sent: bool) -> ProblemError:
    return ProblemError(
        401,
        "token_required",
        expected="Authorization: Bearer with a token of this gateway",
        got="another token" if sent else "no token",
        next_step="ask whoever runs the gateway for one (topnav token add)",
    )


def _role_too_low(token: Token, needed: Role) -> ProblemError:
    whose = f" (token {token.name})" if token.name else ""
    return ProblemError(
        403,
        "role_too_low",
        expected=f"role {needed}",
        got=f"{token.role}{whose}",
        next_step=f"ask somebody who is {needed}",
        needed=needed,
        role=token.role,
    )
