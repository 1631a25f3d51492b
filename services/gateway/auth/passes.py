"""Passes for reading: signed cookies, since pictures, downloads and WebSockets of a page carry no header."""

import hashlib
import hmac
import secrets

from shared.access.token import Token

LIFETIME_S = 12 * 3600.0
MOST_BYTES = 200


class Passes:
    """Issues and checks; the key lives as long as the process, so a restart ends every pass."""

    def __init__(self) -> None:
        self._key = secrets.token_bytes(32)

    def issue(self, token: Token, now_s: float) -> str:
        """A pass of that token's holder, good for `LIFETIME_S`."""
        until_s = int(now_s + LIFETIME_S)
        return f"{token.name}|{until_s}|{self._seal(token, until_s)}"

    @staticmethod
    def name_of(value: str) -> str | None:
        """Whose pass it claims to be; None when it is none at all."""
        name, _, rest = value.partition("|")
        return name if rest and len(value) <= MOST_BYTES else None

    def good(self, value: str, token: Token, now_s: float) -> bool:
        """Whether it is an unexpired pass of that very token: one made anew under its name is another."""
        _, until, seal = value.split("|") if value.count("|") == 2 else ("", "", "")
        if not (until.isascii() and until.isdigit() and float(until) > now_s):
            return False
        return hmac.compare_digest(seal.encode(), self._seal(token, int(until)).encode())

    def _seal(self, token: Token, until_s: int) -> str:
        text = f"{token.name}|{until_s}|{token.sha256}".encode()
        return hmac.new(self._key, text, hashlib.sha256).hexdigest()
