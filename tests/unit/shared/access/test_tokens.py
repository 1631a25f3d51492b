"""Tokens: roles, hashes, and the file they are kept in."""

import json
import stat
from concurrent.futures import ThreadPoolExecutor

import pytest

from shared.access.tokens import (
    ROLES,
    Token,
    check_chosen,
    digest_of,
    find,
    includes,
    kept_secret,
    new_secret,
    read_tokens,
    write_tokens,
)


def token(name="anna", role="operator", secret="s1"):
    return Token(name=name, role=role, sha256=digest_of(secret))


def test_each_role_includes_those_before_it():
    table = [[includes(role, needed) for needed in ROLES] for role in ROLES]
    assert ROLES == ("viewer", "agent", "operator", "admin")
    ranks = range(len(ROLES))
    assert table == [[rank >= needed for needed in ranks] for rank in ranks]


def test_a_secret_leads_to_its_token_and_nothing_else_does():
    tokens = (token(), token("bert", "viewer", "s2"))
    assert find(tokens, "s2") == tokens[1]
    for wrong in ("", "s", "s1 ", "S1", "s\udce4", tokens[0].sha256):
        assert find(tokens, wrong) is None
    assert find((), "s1") is None


def test_secrets_are_long_and_never_the_same():
    made = {new_secret() for _ in range(50)}
    assert len(made) == 50
    assert all(secret.startswith("topnav_") and len(secret) >= 50 for secret in made)


def test_what_is_written_is_read_and_holds_no_secret(tmp_path):
    path = tmp_path / "tokens.json"
    write_tokens(path, [token(secret="topsecret")])
    assert read_tokens(path) == (token(secret="topsecret"),)
    assert "topsecret" not in path.read_text()
    assert stat.S_IMODE(path.stat().st_mode) == 0o644
    assert [entry.name for entry in tmp_path.iterdir()] == ["tokens.json"]


@pytest.mark.parametrize(
    "content",
    [
        "",
        "[]",
        "{",
        '{"format": "topnav-tokens/2"}',
        '{"format": "topnav-tokens/1", "tokens": [{"name": "a", "role": "root", "sha256": "%s"}]}'
        % ("0" * 64),
        '{"format": "topnav-tokens/1", "tokens": [{"name": "a", "role": "admin", "sha256": "00"}]}',
        '{"format": "topnav-tokens/1", "tokens": [{"name": "A b", "role": "admin", "sha256": "%s"}]}'
        % ("0" * 64),
        '{"format": "topnav-tokens/1", "tokens": [{"role": "admin", "sha256": "%s"}]}' % ("0" * 64),
    ],
)
def test_a_file_that_is_none_of_ours_is_refused_by_name(tmp_path, content):
    path = tmp_path / "tokens.json"
    path.write_text(content)
    with pytest.raises(ValueError, match=r"token file .*tokens\.json"):
        read_tokens(path)


def test_two_tokens_of_one_name_are_refused(tmp_path):
    path = tmp_path / "tokens.json"
    entry = token().model_dump()
    path.write_text(json.dumps({"format": "topnav-tokens/1", "tokens": [entry, entry]}))
    with pytest.raises(ValueError, match="a name of its own"):
        read_tokens(path)


def test_a_missing_file_says_how_to_make_it(tmp_path):
    with pytest.raises(ValueError, match="topnav token add NAME --role admin"):
        read_tokens(tmp_path / "none.json")


@pytest.mark.parametrize("secret", ["change-me", "CHANGE-ME", "short", "x" * 15])
def test_chosen_secrets_must_be_long_and_from_no_example(secret):
    with pytest.raises(ValueError, match="TOPNAV_TOKEN must be a secret"):
        check_chosen(secret, "TOPNAV_TOKEN")
    check_chosen("x7" * 8, "TOPNAV_TOKEN")


@pytest.mark.parametrize("secret", ["# an admin's, of 16 signs", '"in-quotes-in-a-file"'])
def test_what_a_line_leaves_that_was_read_wrongly_is_no_secret(secret):
    with pytest.raises(ValueError, match="not begin as a comment or a quotation does") as refused:
        check_chosen(secret, "TOPNAV_TOKEN")
    assert secret not in str(refused.value), "what was refused is somebody's secret all the same"


def test_a_secret_that_nobody_chose_is_made_once_for_all_who_ask(tmp_path):
    file = tmp_path / "token"
    with ThreadPoolExecutor(8) as pool:
        (secret,) = set(pool.map(kept_secret, [file] * 32))
    assert len(secret) == 64
    assert kept_secret(file) == file.read_text() == secret
    assert stat.S_IMODE(file.stat().st_mode) == 0o600
    assert list(tmp_path.iterdir()) == [file]


def test_a_secret_that_cannot_be_kept_is_an_error_that_names_the_file(tmp_path):
    with pytest.raises(ValueError, match=r"the secret in .*nowhere/token cannot be made or read"):
        kept_secret(tmp_path / "nowhere" / "token")
    (tmp_path / "token").write_text("short")
    with pytest.raises(ValueError, match="must be a secret of at least 16"):
        kept_secret(tmp_path / "token")
