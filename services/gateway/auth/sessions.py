"""Signed cookies for reading, since pictures, downloads and WebSockets of a page carry no header."""

import hashlib
import hmac
import secrets
from collections.abc import Callable

from shared.access.tokens import Token

LIFETIME_S = 12 * 3600.0
"""A working day: then the page asks for the token again."""
MOST_CHARACTERS = 200
"""A cookie has 32 of a name, 10 of a time, 64 of a seal and two bars."""


class Sessions:
    """Issues cookies and checks them; the key lives as long as the process: a restart ends every session."""

    def __init__(self) -> None:
        self._key = secrets.token_bytes(32)

    def issue(self, token: Token, now_s: float) -> str:
        """A cookie of that token's holder, good for `LIFETIME_S`."""
        until_s = int(now_s + LIFETIME_S)
        return f"{token.name}|{until_s}|{self._seal(token, until_s)}"

    def token_of(self, cookie: str, named: Callable[[str], Token | None], now_s: float) -> Token | None:
        """The token that an unexpired cookie was issued for; one made anew under its name is another.

        Args:
            cookie: as it was sent, or anything else.
            named: the token that has a name now.
            now_s: Unix seconds.
        """
        name, until, seal = cookie.split("|") if cookie.count("|") == 2 else ("", "", "")
        if len(cookie) > MOST_CHARACTERS or not (
            until.isascii() and until.isdigit() and float(until) > now_s
        ):
            return None
        token = named(name)
        if token is None or not hmac.compare_digest(seal.encode(), self._seal(token, int(until)).encode()):
            return None
        return token

    def _seal(self, token: Token, until_s: int) -> str:
        text = f"{token.name}|{until_s}|{token.sha256}".encode()
        return hmac.new(self._key, text, hashlib.sha256).hexdigest()
