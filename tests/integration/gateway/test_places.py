"""Places and rules through the gateway: the real map store behind it, tokens and roles before it."""

from collections.abc import Iterator
from pathlib import Path

import httpx
import pytest

from services.map_store.storage.database import Database
from services.map_store.store import MapStore
from shared.messages.maps import Edge, PutEdge
from tests.integration.gateway.conftest import serve_gateway
from tests.integration.gateway.gateway_process import WAIT_S
from tests.integration.gateway.keys import NAMES, bearer, write_file
from tests.integration.gateway.standins import served
from tests.unit.services.map_store.conftest import add, app_of

PLACES, RULES = "/api/maps/flat/places", "/api/maps/flat/rules"
KITCHEN = {"name": "Küche & Bad #2?", "nodes": [1, 0]}
SHUT = {"kind": "keep_out", "name": "no robots", "nodes": [1], "areas": []}


@pytest.fixture(scope="module")
def http(endpoint: str, tmp_path_factory: pytest.TempPathFactory) -> Iterator[httpx.Client]:
    """A client of a gateway that asks for tokens, before a map store that does too."""
    folder: Path = tmp_path_factory.mktemp("places")
    database = Database(f"sqlite:///{folder}/maps.sqlite3")
    store = MapStore(database, lambda: 1, lambda _: None)
    store.create("flat")
    store.transact("flat", [add(0), add(1), PutEdge(edge=Edge(a=0, b=1))], author="planner")
    with served(app_of(store, token="inner")) as port:
        settings = {
            "tokens_file": write_file(folder / "tokens.json"),
            "map_store_token": "inner",
            "map_store_url": f"http://127.0.0.1:{port}",
        }
        for address in serve_gateway(endpoint, **settings):
            with httpx.Client(base_url=address, trust_env=False, timeout=WAIT_S) as client:
                yield client
    database.close()


def ask(http: httpx.Client, role: str | None, method: str, path: str, **options: object) -> httpx.Response:
    return http.request(method, path, headers=bearer(role), **options)  # type: ignore[arg-type]


def test_a_place_is_named_found_and_forgotten_whatever_its_name(http: httpx.Client) -> None:
    answer = ask(http, "operator", "PUT", PLACES, json=KITCHEN)
    assert answer.status_code == 200, answer.text
    assert http.get(PLACES, params={"search": "küche & bad #2?"}).json() == [KITCHEN]
    newest = http.get("/api/maps/flat/revisions").json()[0]
    assert (newest["author"], newest["summary"]) == (NAMES["operator"], f"place {KITCHEN['name']!r} named")
    gone = ask(http, "operator", "DELETE", PLACES, params={"name": KITCHEN["name"]})
    assert gone.status_code == 200, gone.text
    assert http.get(PLACES).json() == []


def test_an_unknown_name_is_a_problem_that_tells_the_nearest(http: httpx.Client) -> None:
    ask(http, "operator", "PUT", PLACES, json={"name": "Dock", "nodes": [0]})
    answer = ask(http, "operator", "DELETE", PLACES, params={"name": "dok"})
    assert (answer.status_code, answer.headers["content-type"]) == (404, "application/problem+json")
    assert "no place 'dok'; nearest: 'Dock'" in answer.json()["detail"]


def test_a_rule_is_set_listed_and_lifted_by_an_admin(http: httpx.Client) -> None:
    assert ask(http, "admin", "PUT", RULES, json=SHUT).status_code == 200
    assert http.get(RULES).json() == [SHUT]
    assert ask(http, "admin", "DELETE", RULES, params={"name": "no robots"}).status_code == 200
    assert http.get(RULES).json() == []


@pytest.mark.parametrize(
    ("role", "method", "path", "status"),
    [
        (None, "PUT", PLACES, 401),
        ("viewer", "PUT", PLACES, 403),
        ("viewer", "DELETE", PLACES, 403),
        (None, "PUT", RULES, 401),
        ("operator", "PUT", RULES, 403),
        ("operator", "DELETE", RULES, 403),
    ],
)
def test_names_are_for_operators_and_rules_for_admins(
    http: httpx.Client, role: str | None, method: str, path: str, status: int
) -> None:
    before = http.get(PLACES).json(), http.get(RULES).json()
    body = KITCHEN if path == PLACES else SHUT
    answer = ask(http, role, method, path, params={"name": "Dock"}, json=body)
    assert answer.status_code == status, answer.text
    assert (http.get(PLACES).json(), http.get(RULES).json()) == before


def test_an_operator_cannot_move_an_area_out_of_a_rule(http: httpx.Client) -> None:
    ask(http, "operator", "PUT", PLACES, json={"name": "Lab", "nodes": [1]})
    rule = {"kind": "keep_out", "name": "lab", "areas": ["Lab"]}
    assert ask(http, "admin", "PUT", RULES, json=rule).status_code == 200
    for answer in (
        ask(http, "operator", "PUT", PLACES, json={"name": "LAB", "nodes": [0]}),
        ask(http, "operator", "DELETE", PLACES, params={"name": "Lab"}),
    ):
        assert answer.status_code == 409
        assert "what rule 'lab' is about" in answer.json()["detail"]
    ask(http, "admin", "DELETE", RULES, params={"name": "lab"})


@pytest.mark.parametrize("name", ["a\nb", "\u202egpj.exe", "x" * 65, ""])
def test_names_that_deceive_come_no_further_than_the_store(http: httpx.Client, name: str) -> None:
    answer = ask(http, "operator", "PUT", PLACES, json={"name": name, "nodes": [0]})
    assert (answer.status_code, answer.headers["content-type"]) == (422, "application/problem+json")
