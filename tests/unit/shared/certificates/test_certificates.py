"""Certificates: made once, renewed when asked, checked; keys are their owner's only."""

import datetime as dt
import stat
import subprocess
import sys

import pytest
from cryptography import x509
from typer.testing import CliRunner

from services.launcher.commands.stack.certs import app
from shared.access.rules import Role
from shared.certificates.authority import CERTIFICATE_DAYS
from shared.certificates.checking import check
from shared.certificates.holders import (
    AUTHORITY,
    CertificatesError,
    Holder,
    another_robot,
    everyone,
    hosts_of,
    read_certificate,
)
from shared.certificates.issuing import make, renew

NOW = dt.datetime(2030, 1, 1, tzinfo=dt.UTC)
DAY = dt.timedelta(days=1)


@pytest.fixture
def folder(tmp_path):
    make(tmp_path / "certs", everyone("r1"), NOW)
    return tmp_path / "certs"


def serial(folder, name):
    return read_certificate(folder / name / "certificate.pem").serial_number


def finding(folder, name, now=NOW):
    return next(found for found in check(folder, now) if found.name == name)


def test_everybody_gets_a_certificate_with_the_name_that_the_rules_know(folder):
    names = {found.name: found.common_name for found in check(folder, NOW)}
    assert names["drive"] == "drive.r1"
    assert names["map_store"] == "map_store"
    assert names["ros"] == "robot.r1"
    assert set(names) == {role.value for role in Role} - {"robot"} | {"ros"}


def test_keys_are_for_their_owner_only_and_the_authoritys_is_apart(folder):
    for path in folder.glob("*/key.pem"):
        assert stat.S_IMODE(path.stat().st_mode) == 0o600, path
        assert stat.S_IMODE(path.parent.stat().st_mode) == 0o700, path
    assert sorted(path.name for path in (folder / "drive").iterdir()) == [
        "authority.pem",
        "certificate.pem",
        "key.pem",
    ]
    assert (folder / AUTHORITY / "key.pem").read_bytes() != (folder / "drive" / "key.pem").read_bytes()


def test_only_servers_may_be_connected_to(folder):
    def is_server(name):
        kinds = read_certificate(folder / name / "certificate.pem").extensions
        usage = kinds.get_extension_for_class(x509.ExtendedKeyUsage).value
        return x509.ExtendedKeyUsageOID.SERVER_AUTH in usage

    assert [
        path.name for path in sorted(folder.iterdir()) if path.name != AUTHORITY and is_server(path.name)
    ] == ["map_store", "router"]
    assert "router" in hosts_of(read_certificate(folder / "router" / "certificate.pem"))


def test_nothing_is_overwritten_unasked(folder):
    before = serial(folder, "drive")
    with pytest.raises(CertificatesError, match=r"drive.*--renew"):
        make(folder, everyone("r1"), NOW)
    assert make(folder, everyone("r1"), NOW, keep=True) == []
    assert serial(folder, "drive") == before


def test_what_is_missing_is_made_with_the_same_authority(folder):
    (folder / "drive" / "certificate.pem").unlink()
    assert [holder.name for holder in make(folder, everyone("r1"), NOW, keep=True)] == ["drive"]
    assert not any(found.faults for found in check(folder, NOW))


def test_a_router_that_is_reached_at_one_more_host_gets_a_certificate_that_says_so(folder):
    make(folder, everyone("r1"), NOW, ("10.0.0.1",), keep=True)
    before = serial(folder, "drive")
    made = make(folder, everyone("r1"), NOW, ("fleet.example",), keep=True)
    assert [holder.name for holder in made] == ["router"]
    hosts = hosts_of(read_certificate(folder / "router" / "certificate.pem"))
    assert {"router", "10.0.0.1", "fleet.example"} <= set(hosts)
    assert serial(folder, "drive") == before
    assert make(folder, everyone("r1"), NOW, ("10.0.0.1",), keep=True) == []


def test_a_kept_certificate_of_another_robot_is_refused(folder):
    with pytest.raises(
        CertificatesError, match=r"a certificate of drive\.r2 expected, found one of drive\.r1"
    ):
        make(folder, [Holder("drive", Role.DRIVE, "r2")], NOW, keep=True)


def test_further_robots_and_people_get_certificates_of_their_own(folder):
    make(folder, another_robot("r2"), NOW)
    make(folder, [Holder("tablet", Role.VIEWER, "r1")], NOW)
    assert finding(folder, "drive.r2").common_name == "drive.r2"
    assert finding(folder, "tablet").common_name == "viewer"


@pytest.mark.parametrize("name", ["../out", "", "a/b", AUTHORITY, ".", "a b"])
def test_a_name_that_leads_elsewhere_is_refused(folder, name):
    with pytest.raises(CertificatesError, match="plain word"):
        make(folder, [Holder(name, Role.VIEWER, "r1")], NOW)


def test_renewal_gives_new_keys_under_the_same_names_and_hosts(folder):
    make(folder, [Holder("front", Role.ROUTER, "r1")], NOW, hosts=("lab.example", "10.0.0.7"))
    before, key = serial(folder, "drive"), (folder / "drive" / "key.pem").read_bytes()
    renewed = renew(folder, NOW + 300 * DAY)
    assert {holder.name for holder in renewed} == {holder.name for holder in everyone("r1")} | {"front"}
    assert serial(folder, "drive") != before
    assert (folder / "drive" / "key.pem").read_bytes() != key
    assert {"lab.example", "10.0.0.7"} <= set(
        hosts_of(read_certificate(folder / "front" / "certificate.pem"))
    )
    assert not any(found.faults for found in check(folder, NOW + 301 * DAY))


def test_renewal_without_the_authoritys_key_says_so(folder):
    (folder / AUTHORITY / "key.pem").unlink()
    with pytest.raises(CertificatesError, match="no authority that can sign"):
        renew(folder, NOW)


def test_the_end_of_validity_is_told_a_month_before_and_after(folder):
    end = NOW + CERTIFICATE_DAYS * DAY
    assert finding(folder, "drive", end - 31 * DAY).warnings == ()
    assert "expires on" in finding(folder, "drive", end - 29 * DAY).warnings[0]
    assert "expired on" in finding(folder, "drive", end + DAY).faults[0]
    assert "clock" in finding(folder, "drive", NOW - DAY).faults[0]


def test_a_foreign_or_mixed_certificate_is_found(folder, tmp_path):
    other = tmp_path / "other"
    make(other, everyone("r1"), NOW)
    for name in ("certificate.pem", "key.pem"):
        (folder / "drive" / name).write_bytes((other / "drive" / name).read_bytes())
    (folder / "planner" / "key.pem").write_bytes((other / "planner" / "key.pem").read_bytes())
    (folder / "gateway" / "authority.pem").write_bytes((other / "gateway" / "authority.pem").read_bytes())
    assert "not signed by" in finding(folder, "drive").faults[0]
    assert "do not make a usable certificate" in finding(folder, "planner").faults[0]
    assert "another authority" in finding(folder, "gateway").faults[0]
    (folder / "drive" / "key.pem").unlink()
    assert "key.pem missing" in finding(folder, "drive").faults[0]


def test_a_key_that_others_may_read_is_told(folder):
    (folder / "drive" / "key.pem").chmod(0o644)
    assert "mode 600 expected, got 644" in finding(folder, "drive").warnings[0]


def test_the_shell_makes_checks_and_refuses(tmp_path):
    run = CliRunner().invoke
    assert run(app, [str(tmp_path / "c"), "--robot", "r7"]).exit_code == 0
    assert run(app, [str(tmp_path / "c"), "--check"]).exit_code == 0
    (tmp_path / "c" / "planner" / "certificate.pem").write_text("nonsense")
    checked = run(app, [str(tmp_path / "c"), "--check", "--json"])
    assert checked.exit_code == 1
    assert "drive.r7" in checked.stdout
    again = run(app, [str(tmp_path / "c"), "--robot", "r7"])
    assert isinstance(again.exception, CertificatesError)
    half = run(app, [str(tmp_path / "c"), "--name", "tablet"])
    assert isinstance(half.exception, ValueError)


def test_the_one_shot_of_the_compose_file_may_run_again_and_starts_in_empty_volumes(tmp_path, repository):
    for name in (AUTHORITY, *(holder.name for holder in everyone("r1"))):
        (tmp_path / name).mkdir()
    command = [sys.executable, "-m", "shared.certificates", str(tmp_path)]
    environment = {"TOPNAV_ROBOT": "r1", "TOPNAV_ROBOTS": "r1,r2", "PATH": ""}
    first, second = (
        subprocess.run(
            command, cwd=repository, env=environment, capture_output=True, text=True, timeout=60, check=True
        )
        for _ in range(2)
    )
    assert first.stdout.startswith("23 made, 0 kept")
    assert second.stdout.startswith("0 made, 23 kept")
