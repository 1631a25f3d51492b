"""Every error of an application is a problem document."""

import pytest
from fastapi import FastAPI, Request
from fastapi.testclient import TestClient
from starlette.exceptions import HTTPException

from shared.web import problems
from shared.web.bodies import BodyLimit, BodyLimits
from shared.web.problems import MEDIA_TYPE, ProblemError


@pytest.fixture
def client() -> TestClient:
    """An application in which everything goes wrong."""
    app = FastAPI()
    bug = ProblemError(500, "internal", detail="see the log")
    translations = {HTTPException: lambda _request, error: ProblemError(error.status_code, "x", detail="no")}
    problems.install(
        app, translations, bug, lambda request, p: problems.response(p, instance=request.url.path)
    )
    app.add_middleware(BodyLimits, most=BodyLimit(20, 5.0), exceptions={"/long": BodyLimit(40, 5.0)})

    @app.get("/problem/{status}")
    def problem(status: int) -> None:
        raise ProblemError(status, "too_bad", "a", "b", "do c", headers={"Allow": "GET"}, more=1)

    @app.get("/bug")
    def fail(_request: Request) -> None:
        raise RuntimeError("secret path")

    @app.post("/short")
    @app.post("/long")
    def take(content: list[int]) -> int:
        return len(content)

    return TestClient(app, raise_server_exceptions=False)


def test_a_problem_tells_what_was_expected_what_came_and_what_to_do(client: TestClient) -> None:
    answer = client.get("/problem/409")
    assert answer.headers["content-type"] == MEDIA_TYPE
    assert (answer.headers["cache-control"], answer.headers["allow"]) == ("no-store", "GET")
    assert answer.json() == {
        "type": "urn:topnav:problem:too_bad",
        "title": "too bad",
        "status": 409,
        "detail": "expected a, got b; do c",
        "instance": "/problem/409",
        "expected": "a",
        "got": "b",
        "next": "do c",
        "more": 1,
    }


@pytest.mark.parametrize(
    ("status", "header", "value"),
    [(401, "www-authenticate", "Bearer"), (503, "retry-after", "1"), (429, "retry-after", "1")],
)
def test_some_say_how_to_come_again(client: TestClient, status: int, header: str, value: str) -> None:
    assert client.get(f"/problem/{status}").headers[header] == value
    assert header not in client.get("/problem/404").headers


def test_errors_of_the_framework_are_translated_and_bugs_keep_their_innards(client: TestClient) -> None:
    assert client.get("/nowhere").json()["type"] == "urn:topnav:problem:x"
    answer = client.get("/bug")
    assert (answer.status_code, answer.headers["content-type"]) == (500, MEDIA_TYPE)
    assert answer.json()["detail"] == "see the log"


def test_a_body_that_the_framework_reads_keeps_to_its_limit(client: TestClient) -> None:
    long, headers = b"[" + b"1," * 12 + b"1]", {"Content-Type": "application/json"}
    assert client.post("/short", content=b"[1,2]", headers=headers).json() == 2
    refused = client.post("/short", content=long, headers=headers)
    assert refused.status_code == 413
    assert client.post("/long", content=long, headers=headers).json() == 13
