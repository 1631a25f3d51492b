"""What the tools may ask the gateway: nothing else leaves this process."""

from collections.abc import Mapping
from contextvars import ContextVar
from typing import Any

import httpx
from mcp.server.mcpserver.exceptions import ToolError

from services.mcp.settings import McpSettings
from services.mcp.tools.photos import Picture

Facts = dict[str, Any]
"""An object of the gateway's JSON, whose OpenAPI document says what is in it."""

ASK_S = 30.0
"""Longer than the gateway's own patience with the services behind it."""
LONGEST = 400
"""Characters of a refusal that are passed on."""

CALLER: ContextVar[str | None] = ContextVar("caller", default=None)
"""What the program that asks shows for itself, as an Authorization header; None over stdio."""


class Gateway:
    """One robot and one map, as HTTP calls in the name of whoever calls the tool."""

    def __init__(self, settings: McpSettings, client: httpx.AsyncClient) -> None:
        self.robot, self.map = settings.robot, settings.map
        self._secret = settings.token.get_secret_value()
        self._client = client

    async def frame(self, width_px: int) -> bytes:
        """The newest picture as JPEG."""
        answer = await self._send("GET", f"{self._robot}/frame.jpg", params={"width": width_px})
        return answer.content

    async def robot_facts(self) -> Facts:
        """What is known of the robot: newest frame, mission, emergency stop, distances, body."""
        return await self._json("GET", self._robot)

    async def whereabouts(self) -> Facts:
        """Where the newest picture was taken."""
        return await self._json("GET", f"{self._robot}/whereabouts", params={"map": self.map})

    async def map_facts(self) -> Facts:
        """Counts and revision of the map."""
        return await self._json("GET", f"/api/maps/{self.map}")

    async def places(self, search: str) -> list[Facts]:
        """Named places and areas of the map."""
        answer = await self._send("GET", f"/api/maps/{self.map}/places", params={"search": search})
        found: list[Facts] = answer.json()
        return found

    async def name_place(self, name: str, node: int) -> Facts:
        """Give a node a name."""
        return await self._json("PUT", f"/api/maps/{self.map}/places", json={"name": name, "nodes": [node]})

    async def newest_run(self) -> Facts:
        """The last mission or command that ended; nothing before any."""
        runs: list[Facts] = (await self._send("GET", "/api/runs", params={"limit": 1})).json()
        return runs[0] if runs else {}

    async def check_photo(self, picture: Picture) -> Facts:
        """Where a picture was taken."""
        return await self._json(
            "POST",
            f"{self._robot}/goal-check",
            params={"map": self.map},
            files=_file(picture),
        )

    async def goto_photo(self, picture: Picture, seed: int, max_steps: int) -> Facts:
        """Start driving to where a picture was taken."""
        where = f"{self._robot}/missions/goto"
        wish = {"map": self.map, "seed": seed, "max_steps": max_steps}
        return await self._json("POST", where, params=wish, files=_file(picture))

    async def start(self, kind: str, parameters: Mapping[str, Any], seed: int, max_steps: int) -> Facts:
        """Start a mission of a kind."""
        wish = {"action": kind, "map": self.map, "seed": seed, "max_steps": max_steps}
        parameters = {"parameters": dict(parameters)}
        return await self._json("POST", f"{self._robot}/missions", json=wish | parameters)

    async def wait(self, mission_id: str, timeout_s: float) -> Facts:
        """How a mission stands when it ended or the time is over; without an id the current one."""
        question = {"mission_id": mission_id, "timeout_s": timeout_s}
        return await self._json("GET", f"{self._robot}/mission/wait", params=question)

    async def cancel(self, mission_id: str) -> Facts:
        """End a mission; without an id the current one."""
        where, question = f"{self._robot}/missions/cancel", {"mission_id": mission_id}
        return await self._json("POST", where, params=question)

    async def stop(self, why: str) -> Facts:
        """Engage the emergency stop."""
        wish = {"who": "agent", "why": why}
        return await self._json("POST", f"{self._robot}/estop", json=wish)

    @property
    def _robot(self) -> str:
        return f"/api/robots/{self.robot}"

    async def _json(self, method: str, path: str, **sent: Any) -> Facts:
        told: Facts = (await self._send(method, path, **sent)).json()
        return told

    async def _send(self, method: str, path: str, **sent: Any) -> httpx.Response:
        """Ask as the caller: over HTTP with the token of its request, over stdio with the settings' own.

        Raises:
            ToolError: the gateway refuses or is not there.
        """
        shown = CALLER.get()
        if shown is None and self._secret:
            shown = f"Bearer {self._secret}"
        headers = {"Authorization": shown} if shown else {}
        try:
            answer = await self._client.request(method, path, headers=headers, **sent)
        except httpx.HTTPError as error:
            raise ToolError(
                f"the gateway at {self._client.base_url} does not answer ({type(error).__name__}): "
                "see whether topnav runs"
            ) from error
        if answer.is_error:
            raise ToolError(_refusal(answer))
        return answer


def _file(picture: Picture) -> dict[str, tuple[str, bytes, str]]:
    return {"picture": ("goal", picture.data, picture.media_type)}


def _refusal(answer: httpx.Response) -> str:
    """Why, in the gateway's words."""
    try:
        problem = answer.json()
        told = f"{problem['title']}: {problem['detail']}"
    except (ValueError, KeyError, TypeError):
        told = answer.text
    return f"refused ({answer.status_code}), {told}"[:LONGEST]
