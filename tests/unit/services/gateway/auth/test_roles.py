"""Every operation of the API has the role decided for it; new ones are closed until somebody decides."""

from typing import Any

import pytest
from fastapi import FastAPI

from services.gateway.auth.roles import role_for, with_roles
from services.gateway.settings import GatewaySettings
from shared.bus import open_bus

ADMIN = {
    ("POST", "/api/maps/import"),
    ("PATCH", "/api/maps/{map_name}"),
    ("DELETE", "/api/maps/{map_name}"),
    ("DELETE", "/api/maps/{map_name}/nodes/{node_id}"),
    ("DELETE", "/api/maps/{map_name}/edges/{a}/{b}"),
    ("POST", "/api/maps/{map_name}/undo"),
    ("POST", "/api/maps/{map_name}/merge"),
    ("DELETE", "/api/maps/{map_name}/merge"),
    ("PUT", "/api/maps/{map_name}/rules"),
    ("DELETE", "/api/maps/{map_name}/rules"),
}
AGENT = {
    ("PUT", "/api/maps/{map_name}/places"),
    ("POST", "/api/robots/{robot}/missions"),
    ("POST", "/api/robots/{robot}/missions/goto"),
    ("POST", "/api/robots/{robot}/missions/{action}"),
    ("POST", "/api/robots/{robot}/goal-check"),
    ("POST", "/api/robots/{robot}/tasks"),
    ("DELETE", "/api/robots/{robot}/tasks/{task_id}"),
}
OPERATOR = {
    ("POST", "/api/maps"),
    ("DELETE", "/api/maps/{map_name}/places"),
    ("PUT", "/api/maps/{map_name}/routes"),
    ("DELETE", "/api/maps/{map_name}/routes"),
    ("DELETE", "/api/maps/{map_name}/signs"),
    ("POST", "/api/robots/{robot}/drive"),
    ("DELETE", "/api/robots/{robot}/estop"),
    ("PATCH", "/api/robots/{robot}/tasks/{task_id}"),
    ("PUT", "/api/robots/{robot}/schedules/{name}"),
    ("DELETE", "/api/robots/{robot}/schedules/{name}"),
}
VIEWER = {("POST", "/api/session"), ("DELETE", "/api/session")}
ANYBODY = {("POST", "/api/robots/{robot}/estop")}
OPEN = {"/healthz", "/readyz"}


@pytest.fixture(scope="module")
def document() -> dict[str, Any]:
    """The REST description of the real application."""
    from services.gateway.app import create_app

    with open_bus("tcp/127.0.0.1:9") as bus:
        app: FastAPI = create_app(GatewaySettings(), bus)
        return app.openapi()


def operations(document: dict[str, Any]) -> dict[tuple[str, str], dict[str, Any]]:
    return {
        (method.upper(), path): operation
        for path, methods in document["paths"].items()
        for method, operation in methods.items()
    }


def test_every_write_has_the_role_decided_for_it(document: dict[str, Any]) -> None:
    writes = {key: entry for key, entry in operations(document).items() if key[0] != "GET"}
    decided = {
        **dict.fromkeys(ADMIN, "admin"),
        **dict.fromkeys(AGENT, "agent"),
        **dict.fromkeys(OPERATOR, "operator"),
        **dict.fromkeys(VIEWER, "viewer"),
        **dict.fromkeys(ANYBODY, "anybody"),
    }
    assert {key: entry.get("x-topnav-role") for key, entry in writes.items()} == decided


def test_reading_is_for_viewers_but_for_the_health(document: dict[str, Any]) -> None:
    for (method, path), entry in operations(document).items():
        if method == "GET":
            assert entry.get("x-topnav-role") == (None if path in OPEN else "viewer"), path


def test_refusals_are_described_where_a_token_is_asked_for(document: dict[str, Any]) -> None:
    for (_, path), entry in operations(document).items():
        assert ({"401", "403", "429"} <= entry["responses"].keys()) == (path not in OPEN), path
    assert "HTTPBearer" in document["components"]["securitySchemes"]


@pytest.mark.parametrize("method", ["POST", "PUT", "PATCH", "DELETE", "TRACE", "X"])
def test_what_nobody_decided_is_for_admins(method: str) -> None:
    assert role_for(method, "/api/new") == "admin"


def test_a_final_slash_changes_no_role() -> None:
    for method, path in ANYBODY | OPERATOR | ADMIN | VIEWER:
        assert role_for(method, f"{path}/") == role_for(method, path)


def test_an_operation_without_security_stays_as_it_is() -> None:
    plain = {"paths": {"/healthz": {"get": {"responses": {"200": {}}}}}}
    assert with_roles(plain) == plain
