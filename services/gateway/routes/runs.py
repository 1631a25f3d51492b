"""Runs: explorations and evaluations with their figures."""

import asyncio
from typing import Annotated

from fastapi import APIRouter, Query

from services.gateway.live.runs import Run, list_runs
from services.gateway.state import GatewayDep

router = APIRouter(tags=["runs"])


@router.get("/api/runs")
async def show_runs(gateway: GatewayDep, limit: Annotated[int, Query(ge=1, le=1000)] = 100) -> list[Run]:
    """Missions that ended and commands that were run, newest first; what cannot be read is left out."""
    runs, broken = await asyncio.to_thread(list_runs, gateway.settings.runs_dir, limit)
    gateway.metrics.runs_broken.set(broken)
    return runs
