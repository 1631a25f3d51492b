"""Too often: guesses at tokens, writes and uploads are told when to come again; others go on."""

from collections.abc import Callable, Iterator
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import httpx
import pytest

from shared.bus import Bus
from shared.topics import MAP
from tests.integration.gateway.conftest import serve_gateway
from tests.integration.gateway.gateway_process import WAIT_S
from tests.integration.gateway.keys import SECRETS, bearer, write_file
from tests.integration.gateway.standins import Peer, Planner

PAUSE = "/api/robots/r1/missions/pause"
MATCHES = "/api/maps/flat/edges/1/2/matches"


@pytest.fixture
def strict(endpoint: str, planner: Planner, tmp_path: Path) -> Iterator[str]:
    """A gateway with small limits that hardly fill again while a test runs."""
    assert planner
    yield from serve_gateway(
        endpoint,
        ["planner"],
        tokens_file=write_file(tmp_path / "tokens.json"),
        token="the single token of them all",
        writes_per_s=0.01,
        write_burst=5,
        uploads_per_s=0.01,
        upload_burst=2,
        comparisons_per_s=0.01,
        comparison_burst=3,
        failures_per_s=0.01,
        failure_burst=3,
    )


def client(address: str, source: str = "127.0.0.1") -> httpx.Client:
    return httpx.Client(base_url=address, transport=httpx.HTTPTransport(local_address=source), timeout=WAIT_S)


def refused(answer: httpx.Response) -> bool:
    if answer.status_code != 429:
        return False
    assert 1 <= int(answer.headers["retry-after"]) <= 100
    assert answer.json()["title"] == "too many requests"
    return True


def test_guessing_is_ended_and_an_operator_at_the_same_address_goes_on(strict: str) -> None:
    with client(strict) as http:
        assert http.post(PAUSE, headers=bearer("operator")).status_code == 200
        answers = [http.post(PAUSE, headers={"Authorization": f"Bearer guess {n}"}) for n in range(6)]
        assert [answer.status_code for answer in answers] == [401] * 3 + [429] * 3
        assert refused(answers[-1])
        right_but_new = http.post(PAUSE, headers={"Authorization": f"Bearer {SECRETS['admin']}"})
        assert refused(right_but_new), "an answer to a guess would tell whether it was right"
        assert http.post(PAUSE, headers=bearer("operator")).status_code == 200
        assert http.post("/api/robots/r1/estop").status_code != 429
    with client(strict, "127.0.0.2") as elsewhere:
        assert elsewhere.post(PAUSE, headers=bearer("admin")).status_code == 200


def test_writes_are_limited_for_each_token_and_reading_is_not(strict: str) -> None:
    with client(strict) as http:
        answers = [http.post(PAUSE, headers=bearer("operator")) for _ in range(6)]
        assert [answer.status_code for answer in answers] == [200] * 5 + [429]
        assert refused(answers[-1])
        assert http.post(PAUSE, headers=bearer("admin")).status_code == 200
        assert all(http.get("/api/robots").status_code == 200 for _ in range(50))


def test_comparisons_are_limited_though_they_only_read(strict: str) -> None:
    """They compute where the robot's own questions are answered."""
    with client(strict) as http:
        answers = [http.get(MATCHES, headers=bearer("viewer")) for _ in range(4)]
        assert [refused(answer) for answer in answers] == [False] * 3 + [True]
        assert not refused(http.get(MATCHES, headers=bearer("operator")))
        assert http.get("/api/robots", headers=bearer("viewer")).status_code == 200


@pytest.fixture
def never_compared(endpoint: str) -> Iterator[str]:
    """A gateway whose map store never answers."""

    def setup(bus: Bus) -> Callable[[], None]:
        held = [bus.requests(MAP, map="*")]
        return lambda: held.reverse()

    settings = {"max_comparisons": 3, "max_comparisons_per_client": 2, "compute_timeout_s": 4.0}
    with Peer(endpoint, "map_store", setup):
        yield from serve_gateway(endpoint, ["map_store"], **settings)


def test_only_a_few_comparisons_wait_at_once_and_the_rest_is_told_so(never_compared: str) -> None:
    def code(source: str) -> int:
        with client(never_compared, source) as http:
            return http.get(MATCHES).status_code

    with ThreadPoolExecutor(10) as pool:
        codes = list(pool.map(code, ["127.0.0.1"] * 5 + ["127.0.0.2"] * 5))
    assert sorted(codes)[-3:] == [504] * 3, "three were asked about"
    assert set(codes) <= {429, 503, 504}
    assert max(codes[:5].count(504), codes[5:].count(504)) == 2


def test_uploads_are_limited_more_tightly(strict: str) -> None:
    with client(strict) as http:
        path, headers = (
            "/api/robots/r1/goal-check?map=flat",
            {**bearer("operator"), "Content-Type": "image/png"},
        )
        answers = [http.post(path, content=b"no picture", headers=headers) for _ in range(3)]
        assert [answer.status_code for answer in answers] == [415, 415, 429]
        assert http.post(PAUSE, headers=bearer("operator")).status_code == 200


def test_a_forwarded_address_is_believed_of_named_proxies_only(strict: str) -> None:
    with client(strict) as http:
        for number in range(4):
            headers = {"Authorization": f"Bearer guess {number}", "X-Forwarded-For": f"10.0.0.{number}"}
            last = http.post(PAUSE, headers=headers)
        assert last.status_code == 429
