"""A mission of any kind, asked for by a command: followed to its end, and its figures told."""

from pathlib import Path

from services.launcher.client.failure import ExperimentError
from services.launcher.client.mission import MissionClient
from services.launcher.client.stack import Stack
from services.launcher.terminal.output import print_figures, wide_console, write_json
from services.launcher.terminal.progress import mission_progress
from shared.messages.missions import MissionRequest


def run_mission(stack: Stack, request: MissionRequest, json_file: Path | None) -> None:
    """Start it and follow it to its end; ExperimentError where it does not succeed."""
    kind = request.action
    with mission_progress(wide_console(stderr=True), kind) as watch:
        run = MissionClient(stack.bus, stack.robot).run(request, watch)
    status = run.status
    report = {
        "kind": kind,
        "map": request.map,
        "outcome": status.state,
        "failure": status.failure,
        "reason": status.reason,
        "steps": status.step,
        **{figure.name: figure.value for figure in status.figures},
    }
    write_json(json_file, report)
    print_figures(f"{kind} in {request.map}", report)
    if not run.succeeded:
        raise ExperimentError(f"{kind} ended as {status.failure or status.state}: {status.reason}")
