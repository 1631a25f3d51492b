"""Dependencies of the routes: every API request and WebSocket passes here first."""

from typing import Annotated

from fastapi import Depends, Security
from fastapi.security import HTTPAuthorizationCredentials, HTTPBearer
from starlette.requests import HTTPConnection

from services.gateway.auth.access import Person
from services.gateway.auth.origins import check_host, check_origin
from services.gateway.auth.rules import READS, UPLOADS, role_for
from services.gateway.state import GatewayDep, gateway_of

BEARER = HTTPBearer(auto_error=False, description="secret of a token, see `topnav token add`")


def guard(
    connection: HTTPConnection,
    gateway: GatewayDep,
    _shown: Annotated[HTTPAuthorizationCredentials | None, Security(BEARER)] = None,
) -> Person:
    """Dependency of every API route; counts what changes something.

    Raises:
        ProblemError: 403 foreign host or page or too low a role, 401 no token, 429 too often.
    """
    access = gateway.access
    check_host(connection, access.settings)
    method, path = str(connection.scope["method"]), str(connection.scope["route"].path)
    if method not in READS:
        check_origin(connection, access.settings)
    needed = role_for(method, path)
    stops = needed is None
    if stops and access.settings.estop_needs_token:
        needed = "viewer"
    person = access.admit(connection, method, needed)
    connection.state.person = person
    if method not in READS and not stops:  # a stop is never too many
        access.limits.write(person.client)
        if (method, path) in UPLOADS:
            access.limits.upload(person.client)
    return person


PersonDep = Annotated[Person, Depends(guard)]


def admit_socket(connection: HTTPConnection) -> Person:
    """Let a WebSocket in: a page shows its pass, a program the header.

    Raises:
        ProblemError: 403 foreign host or page, 401 no valid token, 429 too many wrong ones.
    """
    access = gateway_of(connection).access
    check_host(connection, access.settings)
    check_origin(connection, access.settings)
    return access.admit(connection, "GET", "viewer")


def person_of(connection: HTTPConnection) -> Person:
    """Who sent a request that `guard` let in."""
    person = connection.state.person
    assert isinstance(person, Person)
    return person
