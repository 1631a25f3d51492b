"""One token: a name, a role and the hash of a secret that is shown once and kept nowhere. Pure."""

import hashlib
import hmac
import secrets
from collections.abc import Iterable
from typing import Annotated

from pydantic import BaseModel, ConfigDict, Field

from shared.access.roles import Role

PREFIX = "topnav_"
"""Lets people and scanners recognise a secret that lies where it should not."""

SECRET_BYTES = 32
SHORTEST = 16
"""Characters of a secret that somebody chose instead of having it made."""

PLACEHOLDERS = frozenset({"change-me", "changeme", "secret", "token", "password"})
"""What examples put in a secret's place."""

TokenName = Annotated[str, Field(pattern=r"^[a-z0-9_.-]{1,32}$")]
"""The rule for authors in a map's history: that is where the name shows."""


class Token(BaseModel):
    """Attributes: name, empty for the one from GATEWAY_TOKEN; role; SHA-256 of the secret, hexadecimal.

    A plain hash suffices because `new_secret` has 256 random bits: there is no dictionary to try.
    """

    model_config = ConfigDict(frozen=True, extra="forbid")

    name: str = Field(default="", pattern=r"^[a-z0-9_.-]{0,32}$")
    role: Role
    sha256: str = Field(pattern=r"^[0-9a-f]{64}$")


def new_secret() -> str:
    """A secret that nobody guesses."""
    return PREFIX + secrets.token_urlsafe(SECRET_BYTES)


def digest_of(secret: str) -> str:
    """What is kept of a secret."""
    return hashlib.sha256(secret.encode("utf-8", "surrogateescape")).hexdigest()


def find(tokens: Iterable[Token], secret: str) -> Token | None:
    """The token of `secret`. Compares with every one in constant time, so time tells nothing."""
    sent, found = digest_of(secret), None
    for token in tokens:
        if hmac.compare_digest(token.sha256, sent):
            found = token
    return found


def check_chosen(secret: str, variable: str) -> None:
    """Refuse a secret that anybody would try first.

    Raises:
        ValueError: it is an example's placeholder or short.
    """
    if secret.lower() in PLACEHOLDERS or len(secret) < SHORTEST:
        raise ValueError(
            f"{variable} must be a secret of at least {SHORTEST} characters and none from an example, "
            f"got {len(secret)} characters: make one with 'openssl rand -hex 32'"
        )
