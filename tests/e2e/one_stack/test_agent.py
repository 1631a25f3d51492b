"""An agent's errand on real processes, through `topnav mcp` and the official client."""

import asyncio
import sys
from collections.abc import Iterator
from typing import Any

import httpx
import pytest
from mcp import Client, StdioServerParameters

from tests.e2e.one_stack.conftest import MAP, Explored

pytestmark = [pytest.mark.render, pytest.mark.slow, pytest.mark.timeout(900)]

PATIENCE = 8
NAME = "agent's start"


async def told(client: Client, tool: str, **wish: Any) -> Any:
    answer = await client.call_tool(tool, wish)
    assert not answer.is_error, answer.content
    return answer.structured_content


async def arrived(client: Client, mission_id: str) -> str:
    """Wait as an assistant does, in parts that its client bears."""
    for _ in range(PATIENCE):
        mission = await told(client, "wait", mission_id=mission_id, timeout_s=60.0)
        if mission["ended"]:
            break
    return f"{mission['state']} {mission['failure']}".strip()


async def errand(client: Client) -> list[Any]:
    """Name where the robot is, drive to a node, look, come back by the name, ask how it is, stop."""
    steps: list[Any] = [await told(client, "name_place", name=NAME, node=0)]
    steps.append((await told(client, "list_places", search="agent"))["result"])
    steps.append(await arrived(client, (await told(client, "go_to", node=1))["mission_id"]))
    steps.append((await client.call_tool("look", {"width_px": 256})).content[0].type)
    steps.append((await told(client, "where_am_i"))["verdict"])
    back = await told(client, "go_to", place="Agent's start")
    steps.append(await arrived(client, back["mission_id"]))
    steps.append((await told(client, "how_is_it"))["mission"]["state"])
    steps.append((await client.call_tool("go_to", {"place": "nowhere"})).is_error)
    return steps


@pytest.fixture
def unnamed(explored: Explored) -> Iterator[None]:
    """Afterwards the map that all tests share has no place of that name."""
    yield
    places = f"{explored.stack.gateway_url}/api/maps/{MAP}/places"
    httpx.delete(places, params={"name": NAME}, trust_env=False).raise_for_status()


@pytest.mark.usefixtures("unnamed")
def test_an_agent_does_an_errand_of_eight_steps(explored: Explored) -> None:
    explored.game.begin(seed=1)
    arguments = ["-m", "services.launcher", "mcp", "--map", MAP, "--data-dir", str(explored.data_dir)]
    server = StdioServerParameters(command=sys.executable, args=arguments)

    async def run() -> list[Any]:
        async with Client(server) as client:
            return await errand(client)

    place = {"name": NAME, "nodes": [0]}
    steps = asyncio.run(run())
    assert steps[:2] == [place, [place]]
    assert steps[2:4] == ["succeeded", "image"]
    assert steps[4] in ("found", "weak")
    assert steps[5:] == ["succeeded", "succeeded", True]
