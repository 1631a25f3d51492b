"""Whether a process is secured: by a whole certificate folder, not at all, or it must not start."""

import datetime as dt
from pathlib import Path

import pytest

from shared.access.credentials import CredentialsError, credentials_in, secured_endpoint, secured_url
from shared.certificates.holders import everyone
from shared.certificates.issuing import make
from shared.settings import ServiceSettings
from shared.transport.router_config import router_config
from shared.transport.session_config import peer_config


@pytest.fixture
def folder(tmp_path):
    make(tmp_path, everyone("r1"), dt.datetime.now(dt.UTC))
    return tmp_path / "drive"


def test_a_whole_folder_gives_three_files(folder):
    credentials = credentials_in(folder)
    assert credentials is not None
    assert credentials.key == folder / "key.pem"


def test_no_folder_and_an_empty_one_mean_an_open_bus(tmp_path):
    (tmp_path / "empty").mkdir()
    assert credentials_in(None) is None
    assert credentials_in(tmp_path / "empty") is None


@pytest.mark.parametrize("name", ["authority.pem", "certificate.pem", "key.pem"])
def test_half_a_folder_is_refused_with_what_is_missing(folder, name):
    (folder / name).unlink()
    with pytest.raises(CredentialsError, match=f"{name} missing"):
        credentials_in(folder)


@pytest.mark.parametrize("name", ["authority.pem", "certificate.pem", "key.pem"])
def test_a_damaged_file_is_refused(folder, name):
    (folder / name).write_text("nonsense")
    with pytest.raises(CredentialsError, match="do not make a usable certificate"):
        credentials_in(folder)


def test_a_key_of_somebody_else_is_refused(folder):
    (folder / "key.pem").write_bytes((folder.parent / "planner" / "key.pem").read_bytes())
    with pytest.raises(CredentialsError, match="do not make a usable certificate"):
        credentials_in(folder)


def test_a_folder_that_is_not_there_is_refused(tmp_path):
    with pytest.raises(CredentialsError, match="cannot be read"):
        credentials_in(tmp_path / "gone")


def test_an_endpoint_that_asks_for_tls_is_never_opened_without_a_certificate():
    with pytest.raises(CredentialsError, match="set TOPNAV_CERTS"):
        peer_config("tls/127.0.0.1:7447")
    with pytest.raises(CredentialsError, match="set TOPNAV_CERTS"):
        router_config("tls/127.0.0.1:7447")


def test_addresses_keep_their_place():
    assert secured_endpoint("tcp/router:7447") == secured_endpoint("tls/router:7447") == "tls/router:7447"
    assert (
        secured_url("http://map-store:8001")
        == secured_url("https://map-store:8001")
        == "https://map-store:8001"
    )


def test_an_empty_variable_means_no_folder(monkeypatch):
    monkeypatch.setenv("TOPNAV_CERTS", "")
    assert ServiceSettings.from_environment().certs is None
    monkeypatch.setenv("TOPNAV_CERTS", "/run/topnav/certs")
    assert ServiceSettings.from_environment().certs == Path("/run/topnav/certs")
