"""Liveness, readiness and metrics. Whoever supervises the process needs no token for the first two."""

from typing import Any

from fastapi import APIRouter, Depends, Response

from services.gateway.auth.guard import guard
from services.gateway.state import GatewayDep
from shared.web.problems import ProblemError

router = APIRouter(tags=["health"])


@router.get("/healthz")
async def healthz() -> dict[str, str]:
    """This process answers."""
    return {"status": "alive"}


@router.get("/readyz")
async def readyz(gateway: GatewayDep) -> dict[str, Any]:
    """Every service a mission needs is alive on the bus; 503 names those that are not."""
    services = gateway.hub.services
    missing = [name for name in gateway.settings.required_services if not services.get(name)]
    if missing:
        expected = f"living processes of {', '.join(gateway.settings.required_services)}"
        got, next_step = f"none of {', '.join(missing)}", "start what is missing"
        raise ProblemError(503, "not_ready", expected, got, next_step, services=services, missing=missing)
    return {"status": "ready", "services": services}


@router.get("/metrics", response_class=Response, dependencies=[Depends(guard)])
async def metrics(gateway: GatewayDep) -> Response:
    """Counts in Prometheus's text format."""
    return Response(gateway.metrics.text(), media_type="text/plain; version=0.0.4; charset=utf-8")
