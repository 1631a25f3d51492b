"""`topnav token`: who may use the gateway. Secrets are printed once; the file keeps hashes."""

import fcntl
import sys
from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

if TYPE_CHECKING:
    from shared.access.tokens import Token

app = typer.Typer(name="token", no_args_is_help=True, help="Make, list and take away tokens of the gateway.")

RESERVED = frozenset({"planner", "gateway", "rest", "console"})
"""Authors of a map's history that are no persons."""

Name = Annotated[str, typer.Argument(help="Whose token it is; a map's history shows this name.")]
RoleOption = Annotated[
    str,
    typer.Option(
        "--role",
        help="viewer: looks. agent: starts missions. operator: also drives by hand and clears an emergency "
        "stop. admin: changes maps, too.",
    ),
]
File = Annotated[Path, typer.Argument(envvar="GATEWAY_TOKENS_FILE", help="Token file of the gateway.")]


@app.command("add")
def add(name: Name, file: File, role: RoleOption = "viewer") -> None:
    """Make a token and print its secret, once; a running gateway takes it within seconds."""
    from shared.access.tokens import new_secret

    secret = new_secret()
    token = _token(name, role, secret)

    def added(tokens: "tuple[Token, ...]") -> "tuple[Token, ...]":
        if any(known.name == name for known in tokens):
            raise ValueError(f"{file} has a token {name!r} already: remove it first")
        return (*tokens, token)

    _change(file, added)
    sys.stderr.write(f"token of {name} ({role}), shown only now:\n")
    typer.echo(secret)


@app.command("list")
def list_tokens(file: File) -> None:
    """Show names and roles."""
    from shared.access.tokens import read_tokens

    for token in read_tokens(file):
        typer.echo(f"{token.name:32} {token.role}")


@app.command("remove")
def remove(name: Name, file: File) -> None:
    """Take a token away; a running gateway ends what it opened within seconds."""
    from shared.access.tokens import read_tokens

    def removed(tokens: "tuple[Token, ...]") -> "tuple[Token, ...]":
        left = tuple(token for token in tokens if token.name != name)
        if len(left) == len(tokens):
            names = ", ".join(sorted(token.name for token in tokens)) or "none"
            raise ValueError(f"{file} has no token {name!r}; there are: {names}")
        return left

    read_tokens(file)
    _change(file, removed)
    typer.echo(f"{name} is out")


def _change(file: Path, change: "Callable[[tuple[Token, ...]], tuple[Token, ...]]") -> None:
    """Read, change and write while no other command does."""
    from shared.access.tokens import read_tokens, write_tokens

    file.parent.mkdir(parents=True, exist_ok=True)
    with file.with_name(f".{file.name}.lock").open("w") as lock:
        fcntl.flock(lock, fcntl.LOCK_EX)
        write_tokens(file, change(read_tokens(file) if file.exists() else ()))


def _token(name: str, role: str, secret: str) -> "Token":
    from pydantic import TypeAdapter, ValidationError

    from shared.access.tokens import ROLES, Token, TokenName, digest_of

    try:
        TypeAdapter(TokenName).validate_python(name)
    except ValidationError:
        raise ValueError(f"a name is 1 to 32 of a-z, 0-9, '_', '.' and '-', got {name[:40]!r}") from None
    if name in RESERVED:
        raise ValueError(f"{name!r} is the name of a program in the history: choose another")
    for known in ROLES:
        if role == known:
            return Token(name=name, role=known, sha256=digest_of(secret))
    raise ValueError(f"--role must be one of {', '.join(ROLES)}, got {role[:40]!r}")
