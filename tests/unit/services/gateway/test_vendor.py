"""The libraries that come with the page are those that their authors published, licences included."""

import hashlib
import json

import pytest

from services.gateway.app import CONSOLE

VENDOR = CONSOLE / "vendor"
VERSIONS = json.loads((VENDOR / "versions.json").read_text())


@pytest.mark.parametrize("name", sorted(VERSIONS))
def test_a_library_is_the_published_file(name: str) -> None:
    assert hashlib.sha256((VENDOR / name).read_bytes()).hexdigest() == VERSIONS[name]["sha256"]


def test_every_file_is_listed_and_has_a_licence() -> None:
    files = {path.name for path in VENDOR.iterdir()} - {"versions.json"}
    licences = {name for name in files if name.endswith(".LICENSE")}
    assert files - licences == set(VERSIONS)
    assert {name.split(".")[0].lower() for name in licences} == {v["package"] for v in VERSIONS.values()}
