"""Tokens of people and programs: a name, a role and the hash of a secret; and the file that keeps them."""

import hashlib
import hmac
import os
import secrets
import tempfile
from collections.abc import Iterable, Sequence
from contextlib import suppress
from pathlib import Path
from typing import Annotated, Literal, Self, get_args

from pydantic import BaseModel, ConfigDict, Field, ValidationError, model_validator

Role = Literal["viewer", "agent", "operator", "admin"]
"""viewer looks; agent starts and ends missions; operator also drives by hand and lets a stopped robot go;
admin also changes and removes maps."""
ROLES: tuple[Role, ...] = get_args(Role)

PREFIX = "topnav_"
"""Lets people and scanners recognise a secret that lies where it should not."""
SECRET_BYTES = 32
"""256 random bits: no dictionary to try, so that a plain hash of it suffices."""
SHORTEST = 16
"""Characters of a secret that somebody chose: 64 bits when they are random hexadecimal digits."""
PLACEHOLDERS = frozenset({"change-me", "changeme", "secret", "token", "password"})
"""What examples put in a secret's place."""
MAX_FILE_BYTES = 1_000_000
"""Some 5,000 tokens, at 180 bytes each."""
FILE_MODE = 0o644
"""Everybody may read hashes of 256 random bits (a container runs as another user); only the owner writes."""

TokenName = Annotated[str, Field(pattern=r"^[a-z0-9_.-]{1,32}$")]
"""The rule for authors in a map's history: that is where the name shows."""


class Token(BaseModel):
    """Attributes: name, empty for the one from GATEWAY_TOKEN; role; SHA-256 of the secret, hexadecimal."""

    model_config = ConfigDict(frozen=True, extra="forbid")

    name: str = Field(default="", pattern=r"^[a-z0-9_.-]{0,32}$")
    role: Role
    sha256: str = Field(pattern=r"^[0-9a-f]{64}$")


class TokenFile(BaseModel):
    """What stands in the file."""

    model_config = ConfigDict(frozen=True, extra="forbid")

    format: Literal["topnav-tokens/1"] = "topnav-tokens/1"
    tokens: tuple[Token, ...] = ()

    @model_validator(mode="after")
    def _one_name_each(self) -> Self:
        names = [token.name for token in self.tokens]
        if "" in names or len(set(names)) != len(names):
            raise ValueError("every token needs a name of its own")
        return self


def includes(role: Role, needed: Role) -> bool:
    """Whether `role` may do what `needed` may: each role includes the ones before it."""
    return ROLES.index(role) >= ROLES.index(needed)


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
        ValueError: it is an example's placeholder, short, or has signs of a line that was read wrongly, such
            as a comment.
    """
    if secret.lower() in PLACEHOLDERS or len(secret) < SHORTEST or secret.startswith(("#", '"', "'")):
        raise ValueError(
            f"{variable} must be a secret of at least {SHORTEST} characters and none from an example, "
            f"and not begin as a comment or a quotation does, got {len(secret)} characters: "
            "make one with 'openssl rand -hex 32'"
        )


def kept_secret(path: Path) -> str:
    """The secret in a file, made when it is first asked for; of several who ask at once all get the same.

    Raises:
        ValueError: the file cannot be made or read, or holds no such secret.
    """
    try:
        if not path.exists():
            handle, new = tempfile.mkstemp(dir=path.parent)
            with os.fdopen(handle, "w", encoding="ascii") as file:
                file.write(secrets.token_hex(SECRET_BYTES))
                file.flush()
                os.fsync(file.fileno())
            with suppress(FileExistsError):
                os.link(new, path)
            Path(new).unlink()
        secret = path.read_text(encoding="ascii").strip()
    except (OSError, UnicodeDecodeError) as error:
        raise ValueError(f"the secret in {path} cannot be made or read: {error}") from error
    check_chosen(secret, str(path))
    return secret


def read_tokens(path: Path) -> tuple[Token, ...]:
    """All tokens of a file.

    Raises:
        ValueError: it is not there, or not a file of `topnav token`.
    """
    try:
        with path.open("rb") as file:
            content = file.read(MAX_FILE_BYTES + 1)
    except OSError as error:
        raise ValueError(
            f"token file {path} cannot be read ({error.strerror}): make it with "
            f"'topnav token add NAME --role admin {path}'"
        ) from None
    try:
        return TokenFile.model_validate_json(content).tokens
    except ValidationError as error:
        first = error.errors(include_url=False, include_input=False)[0]
        where = ".".join(str(part) for part in first["loc"]) or "the file"
        raise ValueError(
            f"token file {path} is not one of 'topnav token add' ({where}: {first['msg']}): make it anew"
        ) from None


def write_tokens(path: Path, tokens: Sequence[Token]) -> None:
    """Replace the file by one that is written whole, so that no reader sees half of it."""
    content = TokenFile(tokens=tuple(tokens)).model_dump_json(indent=2) + "\n"
    with tempfile.NamedTemporaryFile("w", dir=path.parent, prefix=path.name, delete=False) as new:
        new.write(content)
        new.flush()
        os.fchmod(new.fileno(), FILE_MODE)
        os.fsync(new.fileno())
    Path(new.name).replace(path)
