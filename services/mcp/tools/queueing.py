"""Tools about missions that wait for their turn, and what makes them. None changes a schedule."""

from typing import Annotated, Any

from mcp.server.mcpserver import MCPServer
from mcp.server.mcpserver.exceptions import ToolError
from mcp.types import ToolAnnotations
from pydantic import Field

from services.mcp.answers.tasks import Kind, Queue, Schedule, Task
from services.mcp.gateway import Gateway
from services.mcp.tools.sending import SENDS, Seed, Steps

LOOKS = ToolAnnotations(read_only_hint=True)
CANCELS = ToolAnnotations(read_only_hint=False, destructive_hint=False, idempotent_hint=True)

Ended = Annotated[int, Field(ge=0, le=50, description="how many of those that ended last")]
KindName = Annotated[str, Field(pattern=r"^[a-z0-9_-]{1,64}$", description="as `list_kinds` has it")]
Parameters = Annotated[dict[str, Any], Field(max_length=64, description="of the kind")]
Priority = Annotated[int, Field(ge=0, le=9, description="higher first; people's tasks have 4")]
NewId = Annotated[
    str,
    Field(pattern=r"^[a-z0-9_.-]{0,56}$", description="of your choice: sent again, it is not added twice"),
]
# With anything but a dot in it: ids are parts of paths.
TaskId = Annotated[
    str,
    Field(
        max_length=56, pattern=r"^[a-z0-9_.-]*[a-z0-9_-][a-z0-9_.-]*$", description="as `list_tasks` has it"
    ),
]


def add_queueing(server: MCPServer[Any], gateway: Gateway) -> None:
    """Give the server its tools about tasks and schedules."""

    @server.tool(annotations=LOOKS)
    async def list_kinds() -> list[Kind]:
        """Kinds of mission that can be added as a task, with their parameters."""
        return [Kind.model_validate(kind) for kind in await gateway.kinds() if not kind["by_hand"]]

    @server.tool(annotations=LOOKS)
    async def list_tasks(ended: Ended = 5) -> Queue:
        """Tasks that run and wait, in their order, and what ended last."""
        return Queue.model_validate(await gateway.queue(ended))

    @server.tool(annotations=LOOKS)
    async def list_schedules() -> list[Schedule]:
        """What makes tasks again and again, and when next. Only people change it."""
        return [Schedule.model_validate(schedule) for schedule in await gateway.schedules()]

    @server.tool(annotations=SENDS)
    async def add_task(
        kind: KindName,
        parameters: Parameters,
        priority: Priority = 4,
        task_id: NewId = "",
        max_steps: Steps = 20_000,
        seed: Seed = 0,
    ) -> Task:
        """Add a mission that begins when those before it have ended and the robot is free."""
        if any(known["name"] == kind and known["by_hand"] for known in await gateway.kinds()):
            raise ToolError(f"in a mission {kind!r} a person drives: only people start one")
        wish = {"kind": kind, "parameters": parameters, "priority": priority, "task_id": task_id}
        return Task.model_validate(await gateway.add_task({**wish, "max_steps": max_steps, "seed": seed}))

    @server.tool(annotations=CANCELS)
    async def cancel_task(task_id: TaskId) -> Task:
        """Cancel a task that waits. One that runs is cancelled by people."""
        return Task.model_validate(await gateway.cancel_task(task_id))
