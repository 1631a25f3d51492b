"""Tokens of every role for a gateway under test."""

from pathlib import Path

from shared.access.tokens import ROLES, Token, digest_of, write_tokens

SECRETS = {role: f"secret of the {role}" for role in ROLES}
NAMES = {"viewer": "vera", "agent": "agatha", "operator": "otto", "admin": "ada"}


def write_file(path: Path, without: str = "") -> Path:
    """One token for each role, named after nobody in particular."""
    kept = [role for role in ROLES if role != without]
    write_tokens(path, [Token(name=NAMES[role], role=role, sha256=digest_of(SECRETS[role])) for role in kept])
    return path


def bearer(role: str | None) -> dict[str, str]:
    """The header of a role's token."""
    return {} if role is None else {"Authorization": f"Bearer {SECRETS[role]}"}
