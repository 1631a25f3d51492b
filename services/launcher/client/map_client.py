"""Maps as an evaluation needs them: read over the bus, deleted over REST."""

import os

import httpx

from services.launcher.client.failure import ExperimentError
from services.launcher.client.stack import Stack
from shared.messages import MapReply, MapRequest
from shared.queries import RefusedError
from shared.topics import MAP

TIMEOUT_S = 30.0


def read_map(stack: Stack, name: str) -> MapReply | None:
    """Nodes and edges of a map; None when there is no such map, ExperimentError when it cannot be read."""
    try:
        return stack.bus.ask(MAP, MapRequest(action="read"), TIMEOUT_S, map=name)
    except RefusedError as error:
        if not error.may_be_missing:
            raise ExperimentError(str(error)) from error
        return None


def require_map(stack: Stack, name: str) -> MapReply:
    """Nodes and edges of a map that must have some; raises ExperimentError."""
    found = read_map(stack, name)
    if found is None or not found.nodes:
        raise ExperimentError(f"no map {name!r} here: make it with 'topnav explore --map {name}'")
    return found


def delete_map(stack: Stack, name: str) -> None:
    """Delete a map with its history; raises ExperimentError where the gateway's address is not known."""
    if stack.gateway_url is None:
        raise ExperimentError(f"cannot delete map {name!r} without the gateway: name the stack by --data-dir")
    url = f"{stack.gateway_url}/api/maps/{name}"
    httpx.delete(url, headers=token_header(), timeout=TIMEOUT_S, trust_env=False).raise_for_status()


def token_header() -> dict[str, str]:
    """The header that writes need when the stack has a token (TOPNAV_TOKEN)."""
    token = os.environ.get("TOPNAV_TOKEN", "")
    return {"Authorization": f"Bearer {token}"} if token else {}
