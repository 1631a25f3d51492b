"""`topnav models`: what is here, what is broken, what needs consent."""

import pytest
from typer.testing import CliRunner

from services.features.networks.cache import path_of, state_of
from services.features.networks.catalogue import MODELS, find_model
from services.launcher.client.failure import ExperimentError
from services.launcher.commands.assets.models import app, pull, verify


@pytest.fixture
def cache(monkeypatch, tmp_path):
    monkeypatch.setenv("TORCH_HOME", str(tmp_path))
    monkeypatch.setenv("HF_HOME", str(tmp_path / "hf"))
    folder = tmp_path / "hub" / "checkpoints"
    folder.mkdir(parents=True)
    return folder


def test_the_list_names_every_model_its_licence_and_the_cache(cache):
    shown = CliRunner().invoke(app, ["list"])
    assert shown.exit_code == 0
    assert all(model.name in shown.output for model in MODELS)
    assert "non-commercial" in shown.output
    assert cache.parent.parent.name in shown.output.replace("\n", "")


@pytest.mark.usefixtures("cache")
def test_a_file_that_is_not_what_it_should_be_is_broken():
    model = find_model("aliked-t16")
    assert state_of(model) == "absent"
    path_of(model).write_bytes(b"something else")
    assert state_of(model) == "broken"
    with pytest.raises(ExperimentError, match="broken: aliked-t16"):
        verify(None)


@pytest.mark.usefixtures("cache")
def test_a_file_without_a_known_checksum_is_told_apart():
    model = find_model("sosnet")
    path_of(model).write_bytes(b"weights")
    assert state_of(model) == "unpinned"
    verify(["sosnet"])


@pytest.mark.usefixtures("cache")
def test_what_comes_with_topnav_is_verified_where_nothing_was_pulled(capsys):
    verify(None)
    assert "topnav-slim: verified" in capsys.readouterr().out


def test_non_commercial_models_need_the_flag():
    with pytest.raises(ExperimentError, match="--non-commercial"):
        pull(["superpoint"])


@pytest.mark.usefixtures("cache")
def test_without_a_network_one_line_says_what_to_do(monkeypatch):
    monkeypatch.setenv("https_proxy", "http://127.0.0.1:9")
    with pytest.raises(ExperimentError, match="sosnet could not be loaded") as caught:
        pull(["sosnet"])
    assert "\n" not in str(caught.value)


def test_an_unknown_model_lists_those_there_are():
    with pytest.raises(ValueError, match="aliked-t16"):
        pull(["superglow"])
