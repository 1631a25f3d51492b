"""Tools that wait for the end of a mission, or bring it about. None clears an emergency stop."""

import time
from typing import Annotated, Any

from mcp.server.mcpserver import Context, MCPServer
from mcp.types import ToolAnnotations
from pydantic import Field

from services.mcp.answers.missions import Mission, Stop
from services.mcp.gateway import Gateway

ENDS = ToolAnnotations(read_only_hint=False, destructive_hint=False, idempotent_hint=True)

PART_S = 5.0
"""Chosen: so often somebody who waits hears how it goes; programs give up a silent call after a minute."""

MissionId = Annotated[str, Field(max_length=64, description="of the mission; empty: the current one")]
Patience = Annotated[float, Field(ge=0.0, le=120.0, description="answer after so long at the latest")]
Why = Annotated[str, Field(max_length=400, description="for the person who has to clear it")]


def add_ending(server: MCPServer[Any], gateway: Gateway) -> None:
    """Give the server its tools that wait, cancel and stop."""

    @server.tool(annotations=ToolAnnotations(read_only_hint=True))
    async def wait(ctx: Context[Any, Any], mission_id: MissionId = "", timeout_s: Patience = 30.0) -> Mission:
        """Wait until a mission ends, or until the time is over; `ended` says which."""
        deadline_s = time.monotonic() + timeout_s
        while True:
            left_s = max(deadline_s - time.monotonic(), 0.0)
            told = await gateway.wait(mission_id, min(left_s, PART_S))
            mission = Mission.of(told["mission"])
            if told["done"] or left_s <= PART_S:
                return mission
            await ctx.report_progress(timeout_s - left_s, timeout_s, mission.reason)

    @server.tool(annotations=ENDS)
    async def cancel(mission_id: MissionId = "") -> Mission:
        """End a mission; the robot stands."""
        return Mission.of(await gateway.cancel(mission_id))

    @server.tool(annotations=ENDS)
    async def stop(why: Why) -> Stop:
        """Engage the emergency stop: the robot stands until a person lets it go. You cannot undo this."""
        return Stop.model_validate(await gateway.stop(why))
