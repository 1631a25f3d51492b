"""`topnav map check`, `repair`, `backup` and `restore` beside a running stack, and without one."""

import re
import sqlite3
from collections.abc import Iterator
from contextlib import closing
from pathlib import Path

import httpx
import pytest
from typer.testing import CliRunner, Result

from services.launcher.client.failure import ExperimentError
from services.launcher.commands.maps.map import app
from services.launcher.processes.state import AlreadyRunningError
from services.launcher.processes.supervisor import Launcher
from services.map_store.storage import catalogue
from services.map_store.storage.database import Database
from services.map_store.store import MapStore
from shared.access.tokens import Token, digest_of, new_secret, write_tokens
from tests.faults.lived_maps import link, place
from tests.unit.services.map_store.test_store import damage


@pytest.fixture
def data_dir(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A data folder in which a map store ran: map "flat" has two joined nodes."""
    monkeypatch.setenv("TOPNAV_DATA_DIR", str(tmp_path / "data"))
    store = opened(tmp_path / "data")
    store.create("flat")
    store.transact("flat", [place(0), place(1), link(0, 1)])
    store.database.close()
    return tmp_path / "data"


@pytest.fixture
def stack(data_dir: Path) -> Iterator[Launcher]:
    """A running map store in that folder."""
    with Launcher(data_dir, only=["map-store"]) as launcher:
        yield launcher


def opened(data_dir: Path) -> MapStore:
    return MapStore(Database(f"sqlite:///{data_dir}/maps/maps.sqlite3"), lambda: 1, lambda _: None)


def call(*words: str | Path) -> Result:
    return CliRunner().invoke(app, [str(word) for word in words])


def test_a_running_stack_is_checked_repaired_and_backed_up_but_not_replaced(
    stack: Launcher, data_dir: Path, tmp_path: Path
):
    copy = tmp_path / "maps.backup"
    assert call("check").output == f"maps in {data_dir}: no damage\n"
    told = call("backup", copy)
    assert (told.exit_code, told.output.startswith("1 maps, ")) == (0, True)
    refused = call("restore", copy)
    assert isinstance(refused.exception, AlreadyRunningError)
    assert "stop it with 'topnav down'" in str(refused.exception)

    beside = opened(data_dir)
    damage(beside.database, beside.graph("flat")[1].nodes[1].features)
    beside.database.close()
    found = call("check", "flat")
    assert found.exit_code == 1
    assert re.search(r"flat +│ features of node 1 +│ blob \w+ does not match its checksum", found.output)
    assert call("check").exit_code == 1
    worse = call("backup", copy)
    assert isinstance(worse.exception, ExperimentError)
    assert "features of node 1" in str(worse.exception)
    mended = call("repair", "flat")
    assert mended.output.splitlines() == ["node 1: removed, its features are lost", "flat is at revision 2"]
    assert call("check", "flat").output == "map flat: no damage\n"
    with httpx.Client(base_url=stack.map_store_url, trust_env=False, timeout=30.0) as rest:
        assert rest.get("/maps/flat/revisions").json()[0]["author"] == "repair"


def test_a_backup_is_put_back_while_nothing_runs(data_dir: Path, tmp_path: Path):
    copy, file = tmp_path / "maps.backup", data_dir / "maps" / "maps.sqlite3"
    assert call("backup", copy).exit_code == 0
    file.write_bytes(b"rubbish" * 1_000)
    told = call("restore", copy).output
    kept = Path(told.split("kept as ")[1].replace("\n", ""))
    assert kept.read_bytes() == b"rubbish" * 1_000
    assert sorted(opened(data_dir).graph("flat")[1].nodes) == [0, 1]
    with closing(sqlite3.connect(copy)) as connection:
        assert connection.execute("SELECT name FROM maps").fetchall() == [("flat",)]


@pytest.mark.parametrize("name", ["data/maps/maps.sqlite3", "notes.txt"])
def test_an_export_replaces_nothing_but_an_archive(data_dir: Path, tmp_path: Path, name: str):
    """One slip made an archive of the database, and all maps were gone."""
    (tmp_path / "notes.txt").write_text("mine")
    before = (tmp_path / name).read_bytes()
    refused = call("export", "flat", tmp_path / name)
    assert isinstance(refused.exception, ExperimentError)
    assert "is no archive of a map" in str(refused.exception)
    assert (tmp_path / name).read_bytes() == before
    archive = tmp_path / "flat.zip"
    assert [call("export", "flat", archive).exit_code for _ in range(2)] == [0, 0], (
        "one that is one is replaced"
    )
    assert sorted(path.name for path in tmp_path.iterdir()) == ["data", "flat.zip", "notes.txt"]
    assert data_dir.exists()


def test_a_map_of_old_that_is_called_like_an_option_goes_behind_two_dashes(
    data_dir: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
):
    monkeypatch.setattr(catalogue, "check_new_name", catalogue.check_name)
    store = opened(data_dir)
    store.rename("flat", "--help")
    store.database.close()
    file = tmp_path / "map.zip"
    assert call("export", "--", "--help", file).output.startswith("--help: ")
    assert call("rename", "--", "--help", "flat").output == "--help is now flat\n"
    refused = call("rename", "--", "flat", "--help").exception
    assert isinstance(refused, ExperimentError)
    assert "must not begin with '-'" in str(refused)


def test_where_people_have_tokens_the_map_store_takes_writes_of_the_gateway_and_the_owner_only(
    data_dir: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
):
    """The owner's shell may have a token of the gateway, which is none of the map store."""
    secret, file = new_secret(), tmp_path / "tokens.json"
    write_tokens(file, [Token(name="anna", role="admin", sha256=digest_of(secret))])
    monkeypatch.setenv("TOPNAV_TOKENS_FILE", str(file))
    monkeypatch.delenv("TOPNAV_TOKEN", raising=False)
    with Launcher(data_dir, only=["gateway"]) as launcher:
        rename, anna = {"json": {"name": "house"}}, {"Authorization": f"Bearer {secret}"}
        with httpx.Client(base_url=launcher.map_store_url, trust_env=False, timeout=30.0) as rest:
            for header in ({"X-Topnav-Author": "anna"}, anna):
                refused = rest.patch("/maps/flat", headers=header, **rename)
                assert (refused.status_code, rest.get("/maps/flat").status_code) == (401, 200)
        through = f"{launcher.gateway_url}/api/maps/flat"
        assert httpx.patch(through, headers=anna, trust_env=False, timeout=30.0, **rename).status_code == 200
        monkeypatch.setenv("TOPNAV_TOKEN", secret)
        assert call("rename", "house", "hall").output == "house is now hall\n"
    monkeypatch.delenv("TOPNAV_TOKENS_FILE")
    assert call("rename", "hall", "flat").output == "hall is now flat\n"
