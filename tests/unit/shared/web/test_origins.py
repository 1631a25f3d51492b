"""Host names and origins."""

import pytest
from starlette.requests import HTTPConnection

from shared.web.origins import LOOPBACK_NAMES, check_host, check_origin, is_loopback
from shared.web.problems import ProblemError

NAMES = LOOPBACK_NAMES | {"robot.lan"}
PAGES = ("https://lab.example",)


def connection(**headers: str) -> HTTPConnection:
    raw = [(name.encode(), value.encode()) for name, value in headers.items()]
    return HTTPConnection({"type": "http", "method": "POST", "headers": raw})


@pytest.mark.parametrize("host", ["127.0.0.1:8000", "localhost", "LOCALHOST:8000", "[::1]:8000", "robot.lan"])
def test_names_of_this_machine_pass(host: str) -> None:
    check_host(connection(host=host), NAMES, "")


@pytest.mark.parametrize("host", ["evil.example", "127.0.0.1.evil.example", "", "[", "evil@x"])
def test_other_names_are_dns_rebinding(host: str) -> None:
    with pytest.raises(ProblemError) as caught:
        check_host(connection(host=host), NAMES, "")
    assert (caught.value.status_code, caught.value.code) == (403, "foreign_host")


def test_own_pages_listed_pages_and_programs_pass() -> None:
    check_origin(connection(host="127.0.0.1:8000", origin="http://127.0.0.1:8000"), PAGES, "")
    check_origin(connection(host="127.0.0.1:8000", origin="https://lab.example"), PAGES, "")
    check_origin(connection(host="127.0.0.1:8000"), PAGES, "")


@pytest.mark.parametrize("origin", ["http://evil.example", "null", "http://127.0.0.1:9000", "http://[", ""])
@pytest.mark.parametrize("host", ["127.0.0.1:8000", ""])
def test_other_pages_are_refused(origin: str, host: str) -> None:
    with pytest.raises(ProblemError) as caught:
        check_origin(connection(host=host, origin=origin), PAGES, "")
    assert (caught.value.status_code, caught.value.code) == (403, "foreign_origin")


@pytest.mark.parametrize(
    ("host", "own"),
    [("127.0.0.1", True), ("localhost", True), ("::1", True), ("0.0.0.0", False), ("x", False)],
)
def test_only_this_machine_connects_to_loopback(host: str, own: bool) -> None:
    assert is_loopback(host) is own
