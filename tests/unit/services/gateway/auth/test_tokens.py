"""Which tokens are taken while the file changes."""

from pathlib import Path

import pytest

from services.gateway.auth.tokens import ValidTokens
from services.gateway.settings import GatewaySettings
from shared.access.tokens import Token, digest_of, write_tokens

ANNA = Token(name="anna", role="operator", sha256=digest_of("s1"))
BERT = Token(name="bert", role="viewer", sha256=digest_of("s2"))


@pytest.fixture
def path(tmp_path: Path) -> Path:
    """A file with one token."""
    write_tokens(tmp_path / "tokens.json", [ANNA])
    return tmp_path / "tokens.json"


def role(tokens: ValidTokens, secret: str) -> str | None:
    token = tokens.find(secret)
    return token.role if token else None


def test_added_and_removed_tokens_count_at_once(path: Path) -> None:
    tokens = ValidTokens("", path)
    assert (role(tokens, "s1"), role(tokens, "s2")) == ("operator", None)
    write_tokens(path, [ANNA, BERT])
    assert role(tokens, "s2") == "viewer"
    write_tokens(path, [BERT])
    assert role(tokens, "s1") is None
    assert ANNA not in tokens
    assert BERT in tokens


@pytest.mark.parametrize("content", [None, "{", "[]"])
def test_a_file_that_breaks_opens_nothing_but_the_single_token(path: Path, content: str | None) -> None:
    tokens = ValidTokens("single", path)
    assert role(tokens, "s1") == "operator"
    if content is None:
        path.unlink()
    else:
        path.write_text(content)
    assert role(tokens, "s1") is None
    assert role(tokens, "single") == "admin"
    assert tokens.required
    write_tokens(path, [ANNA])
    assert role(tokens, "s1") == "operator"


def test_tokens_are_asked_for_when_there_is_a_secret_or_a_file(path: Path) -> None:
    assert not ValidTokens("", None).required
    assert ValidTokens("x", None).required
    write_tokens(path, [])
    assert ValidTokens("", path).required


def test_a_gateway_into_which_nobody_could_come_does_not_start(path: Path, tmp_path: Path) -> None:
    ValidTokens.chosen(GatewaySettings(tokens_file=path))
    write_tokens(path, [])
    with pytest.raises(ValueError, match="holds no token: make one"):
        ValidTokens.chosen(GatewaySettings(tokens_file=path))
    with pytest.raises(ValueError, match="cannot be read"):
        ValidTokens.chosen(GatewaySettings(tokens_file=tmp_path / "none.json"))
