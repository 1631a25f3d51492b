"""Host names and origins."""

import pytest
from starlette.requests import HTTPConnection

from services.gateway.auth.origins import check_host, check_origin
from services.gateway.http.problems import ProblemError
from services.gateway.settings import GatewaySettings

LOCAL = GatewaySettings(allowed_origins=("https://lab.example",), allowed_hosts=("robot.lan",))


def connection(**headers: str) -> HTTPConnection:
    raw = [(name.encode(), value.encode()) for name, value in headers.items()]
    return HTTPConnection({"type": "http", "method": "POST", "headers": raw})


@pytest.mark.parametrize("host", ["127.0.0.1:8000", "localhost", "LOCALHOST:8000", "[::1]:8000", "robot.lan"])
def test_names_of_this_machine_pass(host: str) -> None:
    check_host(connection(host=host), LOCAL)


@pytest.mark.parametrize("host", ["evil.example", "127.0.0.1.evil.example", "", "[", "evil@x"])
def test_other_names_are_dns_rebinding(host: str) -> None:
    with pytest.raises(ProblemError) as caught:
        check_host(connection(host=host), LOCAL)
    assert caught.value.code == "foreign_host"


def test_off_loopback_any_name_may_lead_here() -> None:
    check_host(connection(host="robot.example"), GatewaySettings(host="0.0.0.0", allow_open=True))


def test_own_pages_listed_pages_and_programs_pass() -> None:
    check_origin(connection(host="127.0.0.1:8000", origin="http://127.0.0.1:8000"), LOCAL)
    check_origin(connection(host="127.0.0.1:8000", origin="https://lab.example"), LOCAL)
    check_origin(connection(host="127.0.0.1:8000"), LOCAL)


@pytest.mark.parametrize("origin", ["http://evil.example", "null", "http://127.0.0.1:9000", "http://["])
def test_other_pages_are_refused(origin: str) -> None:
    with pytest.raises(ProblemError) as caught:
        check_origin(connection(host="127.0.0.1:8000", origin=origin), LOCAL)
    assert caught.value.code == "foreign_origin"
