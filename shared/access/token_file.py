"""The file of tokens: JSON with names, roles and hashes, written whole so that no reader sees half of it."""

import os
import tempfile
from collections.abc import Sequence
from pathlib import Path
from typing import Literal, Self

from pydantic import BaseModel, ConfigDict, ValidationError, model_validator

from shared.access.token import Token

MAX_BYTES = 1_000_000
MODE = 0o644
"""Everybody may read hashes of 256 random bits (a container runs as another user); only the owner writes."""


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


def read_tokens(path: Path) -> tuple[Token, ...]:
    """All tokens of a file.

    Raises:
        ValueError: it is not there, or not a file of `topnav token`.
    """
    try:
        with path.open("rb") as file:
            content = file.read(MAX_BYTES + 1)
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
    """Replace the file."""
    content = TokenFile(tokens=tuple(tokens)).model_dump_json(indent=2) + "\n"
    with tempfile.NamedTemporaryFile("w", dir=path.parent, prefix=path.name, delete=False) as new:
        new.write(content)
        new.flush()
        os.fchmod(new.fileno(), MODE)
        os.fsync(new.fileno())
    Path(new.name).replace(path)
