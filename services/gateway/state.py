"""What the routes share: one object per application, reached by dependency injection."""

import asyncio
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, field
from typing import Annotated, TypeVar

import httpx
from fastapi import Depends, Path, Query
from pydantic import AfterValidator
from starlette.requests import HTTPConnection

from services.gateway.http.asking import Asker
from services.gateway.http.metrics import Metrics
from services.gateway.http.slots import Slots
from services.gateway.live.coalescing import Coalescer
from services.gateway.live.hands import Hands
from services.gateway.live.hub import Hub
from services.gateway.live.mission_log import MissionLog
from services.gateway.settings import GatewaySettings
from shared.messages.estop import EStopState
from shared.transport.keys import check_queue, check_robot

T = TypeVar("T")


STRANGERS = 4
"""Questions asked at once about robots that nobody heard of: each takes as long as an absent service does."""


@dataclass
class Gateway:
    """Settings and everything that lives as long as the application.

    Attributes:
        asker: asks what pages and scripts want to know.
        stop_asker: asks drive to stop a robot: that waits behind no other question.
        strange_asker: asks about names that no robot was heard of, so that these hold up nobody else.
        missions: record of those that ended.
        store: client of the map store's REST interface.
        hands: passes on how people drive robots.
        pictures: the one thread that decodes and encodes pictures: a large one needs 200 MB while it decodes.
        uploads, imports, sockets: slots for pictures and archives on their way in, and for WebSockets.
        stops: emergency stops that come faster than the service that drives should hear them.
    """

    settings: GatewaySettings
    metrics: Metrics
    asker: Asker
    stop_asker: Asker
    strange_asker: Asker
    hub: Hub
    missions: MissionLog
    store: httpx.AsyncClient
    hands: Hands
    pictures: ThreadPoolExecutor = field(default_factory=lambda: ThreadPoolExecutor(1, "pictures"))

    def __post_init__(self) -> None:
        chosen = self.settings
        self.stops: Coalescer[EStopState] = Coalescer()
        self.uploads = Slots("uploads", chosen.max_uploads, chosen.max_uploads_per_client)
        self.imports = Slots("imports", chosen.max_imports, chosen.max_imports)
        self.comparisons = Slots("comparisons", chosen.max_comparisons, chosen.max_comparisons_per_client)
        self.sockets = Slots("sockets", chosen.max_sockets, chosen.max_sockets_per_client)

    def asker_for(self, robot: str) -> Asker:
        """Who asks about a robot."""
        known = robot == self.settings.robot or self.hub.knows(robot)
        return self.asker if known else self.strange_asker

    async def work(self, job: Callable[[], T]) -> T:
        """Run a picture job on its thread."""
        return await asyncio.get_running_loop().run_in_executor(self.pictures, job)


def gateway_of(connection: HTTPConnection) -> Gateway:
    """The application's `Gateway`, for routes."""
    gateway = connection.app.state.gateway
    assert isinstance(gateway, Gateway)
    return gateway


GatewayDep = Annotated[Gateway, Depends(gateway_of)]
RobotPath = Annotated[
    str, Path(pattern=r"^[a-z0-9_-]{1,64}$", description="name of a robot"), AfterValidator(check_robot)
]
QueuePath = Annotated[
    str,
    Path(pattern=r"^[a-z0-9_-]{1,64}$", description="name of a robot, or any for the fleet's queue"),
    AfterValidator(check_queue),
]
MapPath = Annotated[str, Path(pattern=r"^[a-z0-9_-]{1,64}$", description="name of a map")]
NodePath = Annotated[int, Path(ge=0, lt=2**63, description="number of a node")]
NodeQuery = Annotated[int, Query(ge=0, lt=2**63, description="number of a node")]
MapQuery = Annotated[str, Query(alias="map", pattern=r"^[a-z0-9_-]{1,64}$", description="name of a map")]
