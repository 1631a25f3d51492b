"""What the tools may ask the gateway: nothing else leaves this process."""

from collections.abc import Mapping
from typing import Any

import httpx

from services.mcp.caller import Caller, Facts
from services.mcp.settings import McpSettings
from services.mcp.tools.photos import Picture


class Gateway:
    """One robot and one map, as HTTP calls in the name of whoever calls the tool. All raise `ToolError`."""

    def __init__(self, settings: McpSettings, client: httpx.AsyncClient) -> None:
        self.robot, self.map = settings.robot, settings.map
        self._robot, self._map = f"/api/robots/{settings.robot}", f"/api/maps/{settings.map}"
        self._ask = Caller(client, settings.token.get_secret_value())

    async def frame(self, width_px: int) -> bytes:
        """The newest picture as JPEG."""
        return (await self._ask.send("GET", f"{self._robot}/frame.jpg", params={"width": width_px})).content

    async def robot_facts(self) -> Facts:
        """What is known of the robot: newest frame, mission, emergency stop, distances, body."""
        return await self._ask.json("GET", self._robot)

    async def whereabouts(self) -> Facts:
        """Where the newest picture was taken."""
        return await self._ask.json("GET", f"{self._robot}/whereabouts", params={"map": self.map})

    async def map_facts(self) -> Facts:
        """Counts and revision of the map."""
        return await self._ask.json("GET", self._map)

    async def places(self, search: str) -> list[Facts]:
        """Named places and areas of the map."""
        return await self._ask.list(f"{self._map}/places", params={"search": search})

    async def routes(self, search: str) -> list[Facts]:
        """Routes of the map, with their gaps."""
        return await self._ask.list(f"{self._map}/routes", params={"search": search})

    async def signs(self, search: str) -> list[Facts]:
        """Signs that were read in the map."""
        return await self._ask.list(f"{self._map}/signs", params={"search": search})

    async def name_place(self, name: str, node: int) -> Facts:
        """Give a node a name."""
        return await self._ask.json("PUT", f"{self._map}/places", json={"name": name, "nodes": [node]})

    async def newest_run(self) -> Facts:
        """The last mission or command that ended; nothing before any."""
        runs = await self._ask.list("/api/runs", params={"limit": 1})
        return runs[0] if runs else {}

    async def inspections(self) -> list[Facts]:
        """Rounds of inspections of the map, the newest first."""
        return await self._ask.list(f"{self._map}/inspections")

    async def inspected(self, round_id: str, place: str, *, before: bool) -> bytes:
        """The picture of a place in a round as JPEG, or the one that it was compared with."""
        where, which = f"{self._map}/inspections/{round_id}/picture", {"place": place, "before": before}
        return (await self._ask.send("GET", where, params=which)).content

    async def check_photo(self, picture: Picture) -> Facts:
        """Where a picture was taken."""
        where, on = f"{self._robot}/goal-check", {"map": self.map}
        return await self._ask.json("POST", where, params=on, files=_file(picture))

    async def goto_photo(self, picture: Picture, seed: int, max_steps: int) -> Facts:
        """Start driving to where a picture was taken."""
        where = f"{self._robot}/missions/goto"
        wish = {"map": self.map, "seed": seed, "max_steps": max_steps}
        return await self._ask.json("POST", where, params=wish, files=_file(picture))

    async def kinds(self) -> list[Facts]:
        """Kinds of mission that the robot knows, with their parameters."""
        return await self._ask.list(f"{self._robot}/mission-kinds")

    async def start(self, kind: str, parameters: Mapping[str, Any], seed: int, max_steps: int) -> Facts:
        """Start a mission of a kind."""
        wish = {"action": kind, "map": self.map, "seed": seed, "max_steps": max_steps}
        parameters = {"parameters": dict(parameters)}
        return await self._ask.json("POST", f"{self._robot}/missions", json=wish | parameters)

    async def wait(self, mission_id: str, timeout_s: float) -> Facts:
        """How a mission stands when it ended or the time is over; without an id the current one."""
        question = {"mission_id": mission_id, "timeout_s": timeout_s}
        return await self._ask.json("GET", f"{self._robot}/mission/wait", params=question)

    async def cancel(self, mission_id: str) -> Facts:
        """End a mission; without an id the current one."""
        where, question = f"{self._robot}/missions/cancel", {"mission_id": mission_id}
        return await self._ask.json("POST", where, params=question)

    async def stop(self, why: str) -> Facts:
        """Engage the emergency stop."""
        wish = {"who": "agent", "why": why}
        return await self._ask.json("POST", f"{self._robot}/estop", json=wish)

    async def queue(self, ended: int) -> Facts:
        """Tasks of the robot, and so many of those that ended last."""
        return await self._ask.json("GET", f"{self._robot}/tasks", params={"ended": ended})

    async def add_task(self, errand: Mapping[str, Any]) -> Facts:
        """Put a task on the map into the queue."""
        return await self._ask.json("POST", f"{self._robot}/tasks", json={**errand, "map": self.map})

    async def cancel_task(self, task_id: str) -> Facts:
        """Cancel a task that waits."""
        return await self._ask.json("DELETE", f"{self._robot}/tasks/{task_id}")

    async def schedules(self) -> list[Facts]:
        """Schedules of the robot, with their next due times."""
        return await self._ask.list(f"{self._robot}/schedules")


def _file(picture: Picture) -> dict[str, tuple[str, bytes, str]]:
    return {"picture": ("goal", picture.data, picture.media_type)}
