"""What the routes share: one object per application, reached by dependency injection."""

import asyncio
from collections.abc import Callable, Iterator
from concurrent.futures import ThreadPoolExecutor
from contextlib import contextmanager
from dataclasses import dataclass, field
from typing import Annotated, TypeVar

import httpx
from fastapi import Depends, Path, Query
from starlette.requests import HTTPConnection

from services.gateway.asking import Asker
from services.gateway.live import Hub
from services.gateway.metrics import Metrics
from services.gateway.mission_log import MissionLog
from services.gateway.problems import ProblemError
from services.gateway.settings import GatewaySettings

T = TypeVar("T")


@dataclass
class Gateway:
    """Settings and everything that lives as long as the application.

    Attributes:
        missions: record of those that ended.
        store: client of the map store's REST interface.
        pictures: the one thread that decodes and encodes pictures: a large one needs 200 MB while it decodes.
    """

    settings: GatewaySettings
    metrics: Metrics
    asker: Asker
    hub: Hub
    missions: MissionLog
    store: httpx.AsyncClient
    pictures: ThreadPoolExecutor = field(default_factory=lambda: ThreadPoolExecutor(1, "pictures"))
    uploading: int = 0
    sockets: int = 0

    async def work(self, job: Callable[[], T]) -> T:
        """Run a picture job on its thread."""
        return await asyncio.get_running_loop().run_in_executor(self.pictures, job)

    @contextmanager
    def upload_slot(self) -> Iterator[None]:
        """Hold one of the places for uploads.

        Raises:
            ProblemError: 503, all are taken.
        """
        if self.uploading >= self.settings.max_uploads:
            self.metrics.refused.labels("busy").inc()
            raise ProblemError(
                503,
                "too_many_uploads",
                expected=f"at most {self.settings.max_uploads} pictures at once",
                got="one more",
                next_step="send it again in a second",
            )
        self.uploading += 1
        try:
            yield
        finally:
            self.uploading -= 1


def gateway_of(connection: HTTPConnection) -> Gateway:
    """The application's `Gateway`, for routes."""
    gateway = connection.app.state.gateway
    assert isinstance(gateway, Gateway)
    return gateway


GatewayDep = Annotated[Gateway, Depends(gateway_of)]
RobotPath = Annotated[str, Path(pattern=r"^[a-z0-9_-]{1,64}$", description="name of a robot")]
MapPath = Annotated[str, Path(pattern=r"^[a-z0-9_-]{1,64}$", description="name of a map")]
NodePath = Annotated[int, Path(ge=0, lt=2**63, description="number of a node")]
NodeQuery = Annotated[int, Query(ge=0, lt=2**63, description="number of a node")]
MapQuery = Annotated[str, Query(alias="map", pattern=r"^[a-z0-9_-]{1,64}$", description="name of a map")]
