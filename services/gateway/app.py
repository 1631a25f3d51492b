"""The application: assembles state, routes, error handling and the web console."""

import asyncio
from collections.abc import AsyncIterator
from contextlib import asynccontextmanager
from pathlib import Path

from fastapi import Depends, FastAPI
from fastapi.responses import FileResponse
from fastapi.staticfiles import StaticFiles
from starlette.middleware.gzip import GZipMiddleware

from services.gateway.auth.guard import Access, guard
from services.gateway.auth.roles import with_roles
from services.gateway.auth.tokens import ValidTokens
from services.gateway.http import problems
from services.gateway.http.asking import Asker
from services.gateway.http.map_store_proxy import open_client
from services.gateway.http.metrics import Metrics
from services.gateway.http.response_headers import ResponseHeaders
from services.gateway.live.bridge import BEAT_S, Bridge
from services.gateway.live.hands import Hands
from services.gateway.live.hub import Hub
from services.gateway.live.mission_log import MissionLog
from services.gateway.routes import (
    driving,
    estop,
    evidence,
    goals,
    health,
    live,
    maps,
    missions,
    robots,
    runs,
    schedules,
    session,
    tasks,
    whereabouts,
)
from services.gateway.settings import GatewaySettings
from services.gateway.state import STRANGERS, Gateway
from shared.bus import Bus
from shared.web.openapi import describe

CONSOLE = Path(__file__).resolve().parent / "console"

GUARDED = (
    driving,
    estop,
    evidence,
    goals,
    missions,
    maps,
    robots,
    runs,
    schedules,
    session,
    tasks,
    whereabouts,
)
"""Routes that ask who sends a request."""


def create_app(settings: GatewaySettings, bus: Bus) -> FastAPI:
    """Build the application; the bridge to `bus` runs from its start to its end.

    Raises:
        ValueError: the token file cannot be read or holds none.
    """
    metrics = Metrics(bus.counters.snapshot)

    @asynccontextmanager
    async def lifespan(app: FastAPI) -> AsyncIterator[None]:
        log = MissionLog(settings.runs_dir, metrics)
        hub = Hub(metrics, settings.max_robots, log.take)
        secret = settings.map_store_token.get_secret_value()
        store = open_client(str(settings.map_store_url), secret, settings.certs)
        askers = (Asker(bus, metrics), Asker(bus, metrics), Asker(bus, metrics, STRANGERS))
        gateway = Gateway(settings, metrics, *askers, hub, log, store, Hands(bus))
        app.state.gateway = gateway
        bridge = Bridge(bus, hub, asyncio.get_running_loop(), settings.robot, settings.max_robots)
        bridge.start()
        beat = asyncio.create_task(_beat(hub))
        try:
            yield
        finally:
            beat.cancel()
            bridge.stop()
            for asker in askers:
                asker.close()
            gateway.pictures.shutdown(wait=False, cancel_futures=True)
            await gateway.store.aclose()

    # No /docs: its scripts come from a CDN, which the page's policy and offline machines forbid.
    app = FastAPI(title="topnav gateway", version="1", lifespan=lifespan, docs_url=None, redoc_url=None)
    app.state.access = Access(settings, ValidTokens.chosen(settings))
    problems.install(app, metrics)
    app.add_middleware(ResponseHeaders, metrics=metrics)
    for resource in GUARDED:
        app.include_router(resource.router, dependencies=[Depends(guard)])
    for open_to_all in (live, health):
        app.include_router(open_to_all.router)
    _serve_console(app)
    describe(app, with_roles)
    return app


def _serve_console(app: FastAPI) -> None:
    @app.get("/", include_in_schema=False)
    async def index() -> FileResponse:
        """The page; asks again each time so that an update shows at once."""
        return FileResponse(CONSOLE / "index.html", headers={"Cache-Control": "no-cache"})

    app.mount("/static", GZipMiddleware(StaticFiles(directory=CONSOLE)), name="static")


async def _beat(hub: Hub) -> None:
    while True:
        await asyncio.sleep(BEAT_S)
        hub.beat()
