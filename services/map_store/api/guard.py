"""Who may use REST: holders of the token, under this machine's names, and no page of another origin."""

import hmac
from collections.abc import Callable, Collection

from fastapi import HTTPException, Request

from shared.web.origins import check_host, check_origin


def reader_guard(token: str, names: Collection[str] | None) -> Callable[[Request], None]:
    """A dependency of every route.

    Args:
        token: that reading needs; empty = none.
        names: what Host may say, against DNS rebinding; None = anything.
    """

    def check(request: Request) -> None:
        if names is not None:
            check_host(request, names, "others may not lead here")
        _check_token(request, token, "this map store needs")

    return check


def writer_guard(token: str) -> Callable[[Request], None]:
    """A dependency for routes that write; an empty token lets everyone on this host write."""

    def check(request: Request) -> None:
        check_origin(request, (), "write from a program")
        _check_token(request, token, "writes need")

    return check


def _check_token(request: Request, token: str, who: str) -> None:
    given, expected = request.headers.get("authorization", "").encode(), f"Bearer {token}".encode()
    if token and not hmac.compare_digest(given, expected):
        raise HTTPException(401, f"{who} 'Authorization: Bearer <token>'")
