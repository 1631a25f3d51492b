"""What a program does with a robot through the official client, over both transports."""

import base64
import io
import json
from typing import Any

import pytest
from mcp import Client
from PIL import Image

from shared.bus import wait_until
from tests.integration.gateway.gateway_process import WAIT_S
from tests.integration.gateway.standins import Planner
from tests.integration.mcp.conftest import ByHttp, by_stdio, during

TOOLS = {
    *("look", "where_am_i", "locate", "how_is_it"),
    *("list_places", "name_place"),
    *("go_to", "explore", "patrol", "wait", "cancel", "stop"),
}


@pytest.fixture(params=["stdio", "http"])
def agent(request: pytest.FixtureRequest, guarded: str, served: str) -> Any:
    """A program with the token of an agent."""
    return by_stdio(guarded, "agent") if request.param == "stdio" else ByHttp(served, "agent")


def panorama() -> str:
    """A picture as it travels in an argument."""
    file = io.BytesIO()
    Image.new("RGB", (256, 128), (10, 90, 160)).save(file, "JPEG")
    return base64.b64encode(file.getvalue()).decode()


def test_an_agent_looks_drives_and_waits(agent: Any, planner: Planner) -> None:
    async def errand(client: Client) -> dict[str, Any]:
        told: dict[str, Any] = {"tools": {tool.name for tool in (await client.list_tools()).tools}}
        (picture,) = (await client.call_tool("look", {"width_px": 128})).content
        told["picture"] = Image.open(io.BytesIO(base64.b64decode(picture.data))).size
        for name, tool, wish in (
            ("here", "where_am_i", {}),
            ("there", "locate", {"photo": panorama()}),
            ("off", "go_to", {"node": 3}),
            ("on the way", "wait", {"timeout_s": 0.0}),
            ("robot", "how_is_it", {}),
            ("cancelled", "cancel", {}),
            ("by photo", "go_to", {"photo": panorama(), "max_steps": 70}),
            ("home", "cancel", {}),
        ):
            answer = await client.call_tool(tool, wish)
            assert not answer.is_error, answer.content
            told[name] = answer.structured_content
        (page,) = (await client.read_resource("topnav://map")).contents
        told["map"] = json.loads(page.text)
        return told

    told = during(agent, errand)
    assert told["tools"] == TOOLS
    assert told["picture"] == (128, 64)
    place = {"verdict": "found", "places": [{"nodes": [7], "support": 71}]}
    assert (told["here"], told["there"]) == (place, place)
    assert (told["off"]["action"], told["off"]["state"], told["off"]["ended"]) == ("goto", "running", False)
    assert told["on the way"]["mission_id"] == told["off"]["mission_id"]
    assert (told["robot"]["robot"], told["robot"]["stopped"]) == ("r1", False)
    assert (told["cancelled"]["state"], told["cancelled"]["ended"]) == ("cancelled", True)
    assert told["map"]["name"] == "flat"
    by_node, by_photo = [wish for wish in planner.asked if wish.action == "goto"][-2:]
    assert (by_node.map, by_node.parameters) == ("flat", {"goal_node": 3})
    assert (by_photo.goal is not None, by_photo.max_steps) == (True, 70)


def test_who_waits_hears_how_it_goes_and_of_the_end(guarded: str, planner: Planner) -> None:
    async def errand(client: Client) -> Any:
        off = await client.call_tool("explore", {})
        planner.say(state="succeeded", reason="nothing is left to see")
        ended = await client.call_tool("wait", {"mission_id": off.structured_content["mission_id"]})
        return ended.structured_content

    ended = during(by_stdio(guarded, "agent"), errand)
    assert (ended["ended"], ended["state"], ended["reason"]) == (True, "succeeded", "nothing is left to see")


def test_a_stop_holds_and_no_tool_lifts_it(guarded: str, drive: list[Any]) -> None:
    async def errand(client: Client) -> Any:
        stopped = await client.call_tool("stop", {"why": "a child on the stairs"})
        return stopped.structured_content, (await client.call_tool("how_is_it")).structured_content

    stopped, robot = during(by_stdio(guarded, "agent"), errand)
    assert (stopped["engaged"], stopped["why"]) == (True, "a child on the stairs")
    assert stopped["who"].endswith("(token agatha)")
    assert robot["stopped"]
    assert wait_until(lambda: drive[0].state.engaged, WAIT_S)
