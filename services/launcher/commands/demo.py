"""`topnav demo`: explore an apartment nobody has seen, then find a hidden robot from one uploaded picture."""

import os
import socket
from dataclasses import dataclass
from pathlib import Path
from typing import Annotated

import httpx
import numpy as np
import typer
from rich.console import Console

from services.launcher.client.failure import ExperimentError, one_line_errors
from services.launcher.client.map_client import token_header
from services.launcher.client.stack import Stack, StackChoice, open_stack
from services.launcher.drawing.pictures import png_bytes
from services.launcher.drawing.plans import draw_map
from services.launcher.evaluation.demo_report import write_report
from services.launcher.evaluation.drawings import draw_round
from services.launcher.evaluation.exploration import Exploration, explore, figures
from services.launcher.evaluation.rounds import Game, Round
from services.launcher.evaluation.truth_file import save_truth, truth_path
from services.launcher.processes.stack_settings import HOST, Ports
from services.launcher.terminal import options
from services.launcher.terminal.output import new_run_folder, write_json
from services.launcher.terminal.progress import mission_progress
from services.launcher.terminal.tables import print_rows, wide_console
from shared.lifecycle import stop_on_signals
from shared.messages import MissionStatus
from simulator.world.freespace import FreeSpace, free_space
from simulator.world.world_file import WorldFile, load_world

app = typer.Typer(add_completion=False, pretty_exceptions_enable=False)

MAP = "demo"
UPLOAD_TIMEOUT_S = 60.0
SEEK_STEPS = 1500
MAP_SHOWN = ("nodes", "edges", "coverage", "components", "false_edges", "collisions", "steps", "wall_s")
GOTO_SHOWN = ("success", "final_distance_m", "spl", "shortest_m", "driven_m", "collisions", "steps", "wall_s")


@dataclass(frozen=True)
class Scene:
    """Where the demo takes place."""

    world: WorldFile
    space: FreeSpace
    seed: int
    folder: Path


@app.command()
def main(
    world: options.World = "apartment",
    seed: options.Seed = 1,
    explore_steps: Annotated[int, typer.Option(min=1, help="Go seeking after so many at the latest.")] = 5000,
    runs: Annotated[Path, typer.Option(help="The report goes to a new folder in here.")] = options.RUNS_DIR,
    keep: Annotated[
        bool, typer.Option(envvar="KEEP", help="Leave everything and the web page up until Ctrl+C.")
    ] = False,
) -> None:
    """Explore the apartment, then find a hidden robot from its picture; ends with the report's path."""
    console = wide_console()
    file = load_world(world)
    scene = Scene(file, free_space(file), seed, new_run_folder(runs))
    choice = StackChoice(scene.folder / "data", world, seed, lockstep=True, ports=_usual_ports())
    console.print(f"starting all services, logs in {choice.data_dir / 'launcher' / 'logs'}", highlight=False)
    with one_line_errors(), open_stack(choice) as stack:
        console.print(f"all up; watch the robot on {stack.gateway_url}", highlight=False)
        explored = _explore(console, stack, scene, choice.data_dir, explore_steps)
        found = _seek(console, stack, scene, explored)
        report = _report(scene, explored, found)
        console.print(f"report: {report}", highlight=False, soft_wrap=True)
        if keep:
            _wait(console, f"everything stays up on {stack.gateway_url}; stop it with Ctrl+C")
    if not found.success:
        raise ExperimentError(f"the hidden robot was not found: {found.run.status.reason}")


def _explore(console: Console, stack: Stack, scene: Scene, data_dir: Path, max_steps: int) -> Exploration:
    with mission_progress(console, "exploring") as watch:
        explored = explore(stack, scene.world.name, MAP, scene.seed, max_steps, watch=watch)
    save_truth(truth_path(data_dir, MAP), MAP, explored.truth)
    draw_map(scene.folder / "map.png", scene.world, explored.truth.poses, explored.graph.edges)
    status = explored.run.status
    console.print(
        f"explored in {status.step} steps: {status.nodes} places, {status.edges} edges", highlight=False
    )
    if not explored.run.succeeded and status.failure != "timeout":
        raise ExperimentError(f"exploration ended as {status.state}: {status.reason}")
    return explored


def _seek(console: Console, stack: Stack, scene: Scene, explored: Exploration) -> Round:
    with stack.session() as own:
        game = Game(own, scene.space, MAP, np.random.default_rng(scene.seed))
        start, hider = game.choose()
        picture = game.hide(hider)
        moved = game.hand.moves
        with mission_progress(console, "seeking") as watch:
            run = game.client.follow(_upload(stack, png_bytes(picture)), watch)
        found = game.finish(start, hider, picture, run, game.hand.moves - moved)
        draw_round(scene.folder, scene.world, found, explored.truth.poses, explored.graph.edges, game)
    return found


def _upload(stack: Stack, png: bytes) -> MissionStatus:
    """Send the picture as anybody would, over HTTP; returns the mission it started."""
    answer = httpx.post(
        f"{stack.gateway_url}/api/robots/{stack.robot}/missions/goto",
        params={"map": MAP, "max_steps": SEEK_STEPS},
        content=png,
        headers={"Content-Type": "image/png", **token_header()},
        timeout=UPLOAD_TIMEOUT_S,
        trust_env=False,
    )
    answer.raise_for_status()
    return MissionStatus.model_validate(answer.json())


def _report(scene: Scene, explored: Exploration, found: Round) -> Path:
    mapping = figures(explored, scene.space, MAP, scene.seed)
    metrics = {"explore": mapping, "goto": found.figures()}
    write_json(scene.folder / "metrics.json", metrics)
    goto = found.figures()
    print_rows("the map", [{name: mapping[name] for name in MAP_SHOWN}])
    print_rows("finding the hidden robot", [{name: goto[name] for name in GOTO_SHOWN}])
    return write_report(scene.folder, mapping, goto)


def _usual_ports() -> Ports:
    """The documented ports where they are free, so that the console is where the README says; else others."""
    usual = Ports.from_variables(os.environ)
    try:
        for port in (usual.router, usual.gateway, usual.map_store):
            with socket.socket() as probe:
                probe.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
                probe.bind((HOST, port))
    except OSError:
        return Ports.free()
    return usual


def _wait(console: Console, text: str) -> None:
    console.print(text, highlight=False)
    stop_on_signals().wait()
