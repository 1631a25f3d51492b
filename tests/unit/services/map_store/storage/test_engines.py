"""URLs of databases: those that operators hand out, and those that cannot be."""

import sys

import pytest

from services.map_store.errors import UnavailableError
from services.map_store.storage.engines import is_sqlite, open_engines, parse


@pytest.mark.parametrize("scheme", ["postgresql", "postgres", "postgresql+psycopg"])
def test_every_common_name_of_postgresql_gets_the_driver_that_is_installed(scheme: str):
    url = parse(f"{scheme}://topnav:a%40b@db:5432/maps?sslmode=verify-full")
    assert (url.drivername, url.password, url.port) == ("postgresql+psycopg", "a@b", 5432)
    assert url.query == {"sslmode": "verify-full"}
    assert not is_sqlite(url)


def test_a_file_is_sqlite():
    assert is_sqlite(parse("sqlite:////var/lib/topnav/maps/maps.sqlite3"))


@pytest.mark.parametrize(
    ("url", "told"),
    [
        ("mysql://root:s3cret@db/maps", "must begin with sqlite:/// or postgresql://, got mysql://"),
        ("s3cret", "no URL of a database"),
        ("postgresql://topnav:s3cret@db:port/maps", "no URL of a database"),
        ("", "no URL of a database"),
    ],
)
def test_other_urls_are_refused_without_saying_a_password(url: str, told: str):
    with pytest.raises(UnavailableError, match=told) as refused:
        parse(url)
    assert "s3cret" not in str(refused.value)


@pytest.mark.parametrize("url", ["sqlite://", "sqlite:///:memory:"])
def test_maps_are_not_kept_in_memory(url: str):
    with pytest.raises(UnavailableError, match="must name a file"):
        open_engines(parse(url))


def test_a_missing_driver_is_named_with_what_installs_it(monkeypatch: pytest.MonkeyPatch):
    monkeypatch.setitem(sys.modules, "psycopg", None)
    with pytest.raises(UnavailableError, match=r"psycopg.*pip install 'topnav\[map-store,postgres\]'"):
        open_engines(parse("postgresql://db/maps"))
