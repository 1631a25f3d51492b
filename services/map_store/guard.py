"""Who may write over REST: holders of the token, and no page of another origin."""

import hmac
from collections.abc import Callable
from urllib.parse import urlsplit

from fastapi import HTTPException, Request


def writer_guard(token: str) -> Callable[[Request], None]:
    """A dependency for routes that write; an empty token lets everyone on this host write."""
    expected = f"Bearer {token}".encode()

    def check(request: Request) -> None:
        origin = request.headers.get("origin")
        if origin is not None and urlsplit(origin).netloc != request.headers.get("host"):
            raise HTTPException(403, f"pages of {origin[:80]} may not write here")
        given = request.headers.get("authorization", "").encode()
        if token and not hmac.compare_digest(given, expected):
            raise HTTPException(
                401, "writes need 'Authorization: Bearer <token>'", {"WWW-Authenticate": "Bearer"}
            )

    return check
