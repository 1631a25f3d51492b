"""The demo: explore a world nobody has seen, find a hidden robot from one uploaded picture, report."""

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

import httpx
import numpy as np
from rich.console import Console

from services.launcher.client.failure import ExperimentError
from services.launcher.client.maps import token_header
from services.launcher.client.stack import Stack
from services.launcher.drawing.pictures import png_bytes
from services.launcher.drawing.plans import draw_map
from services.launcher.evaluation.exploration import Exploration, explore, figures
from services.launcher.evaluation.outcome import Round, draw_round
from services.launcher.evaluation.rounds import Game
from services.launcher.evaluation.truth_file import save_truth, truth_path
from services.launcher.terminal.output import print_rows, write_json
from services.launcher.terminal.progress import mission_progress
from shared.messages.missions import MissionStatus
from simulator.world.freespace import FreeSpace
from simulator.world.world_file import WorldFile

MAP = "demo"
UPLOAD_TIMEOUT_S = 60.0
"""A panorama as PNG is extracted before the answer: seconds on a loaded machine."""

SEEK_STEPS = 1500
"""Crossing the apartment takes 100 to 300 steps; the rest is for a robot that loses itself."""

MAP_SHOWN = ("nodes", "edges", "coverage", "components", "false_edges", "collisions", "steps", "wall_s")
GOTO_SHOWN = ("success", "final_distance_m", "spl", "shortest_m", "driven_m", "collisions", "steps", "wall_s")
HEAD = """# A robot explores, remembers, and finds a picture

It has one 360-degree camera and 12 distance sensors, and never knew where it was in metres.
The drawings show true positions, which only this report has seen.
"""
PICTURES = (
    ("The map", "map.png", "Blue: nodes and the edges between them. Yellow: walls. Grey: furniture."),
    ("The picture it was given", "goal.png", "Uploaded over HTTP, taken by the hidden robot."),
    ("The way it took", "path.png", "Green: start. Purple: via points. Red: where the picture was taken."),
    ("What the seeker saw at the end", "seeker_final.png", ""),
    ("What the hidden robot saw", "hider_final.png", ""),
)


@dataclass(frozen=True)
class Scene:
    """Where the demo takes place."""

    world: WorldFile
    space: FreeSpace
    seed: int
    folder: Path


def play(console: Console, stack: Stack, scene: Scene, data_dir: Path, explore_steps: int) -> Round:
    """All of it; returns how the seeking went."""
    console.print(f"all up; watch the robot on {stack.gateway_url}", highlight=False)
    explored = explore_scene(console, stack, scene, data_dir, explore_steps)
    found = seek_hidden_robot(console, stack, scene, explored)
    console.print(f"report: {report(scene, explored, found)}", highlight=False, soft_wrap=True)
    return found


def require_found(found: Round) -> None:
    """Do nothing where the hidden robot was found.

    Raises:
        ExperimentError: it was not.
    """
    if not found.success:
        raise ExperimentError(f"the hidden robot was not found: {found.run.status.reason}")


def explore_scene(
    console: Console, stack: Stack, scene: Scene, data_dir: Path, max_steps: int
) -> Exploration:
    """Explore, keep the truth of the map and draw it.

    Raises:
        ExperimentError: it ended otherwise than complete or out of steps.
    """
    with mission_progress(console, "exploring") as watch:
        explored = explore(stack, scene.world.name, MAP, scene.seed, max_steps, watch=watch)
    save_truth(truth_path(data_dir, MAP), MAP, explored.truth)
    draw_map(scene.folder / "map.png", scene.world, explored.truth.poses, explored.graph.edges)
    status = explored.run.status
    console.print(
        f"explored in {status.step} steps: {status.nodes} nodes, {status.edges} edges", highlight=False
    )
    if not explored.run.succeeded and status.failure != "timeout":
        raise ExperimentError(f"exploration ended as {status.state}: {status.reason}")
    return explored


def seek_hidden_robot(console: Console, stack: Stack, scene: Scene, explored: Exploration) -> Round:
    """One round whose picture goes over HTTP, and its drawings."""
    with stack.session() as own:
        game = Game(own, scene.space, MAP, np.random.default_rng(scene.seed))
        start, hider = game.choose()
        with mission_progress(console, "seeking") as watch:
            found = game.seek_by(
                start, hider, lambda picture: game.client.follow(_upload(stack, png_bytes(picture)), watch)
            )
        views = game.final_views(hider)
        draw_round(scene.folder, scene.world, found, explored.truth.poses, explored.graph.edges, views)
    return found


def report(scene: Scene, explored: Exploration, found: Round) -> Path:
    """Print the figures, write them and a page with the drawings; returns the page's path."""
    mapping, goto = figures(explored, scene.space, MAP, scene.seed), found.figures()
    write_json(scene.folder / "metrics.json", {"explore": mapping, "goto": goto})
    print_rows("the map", [mapping], MAP_SHOWN)
    print_rows("finding the hidden robot", [goto], GOTO_SHOWN)
    parts = [HEAD, _table("Exploring", mapping), _table("Finding the hidden robot", goto)]
    parts += [f"## {title}\n\n{text}\n\n![{title}]({name})\n" for title, name, text in PICTURES]
    path = scene.folder / "report.md"
    path.write_text("\n".join(parts), encoding="utf-8")
    return path


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


def _table(title: str, figures: Mapping[str, object]) -> str:
    plain = {name: value for name, value in figures.items() if isinstance(value, str | int | float)}
    rows = [f"| {name} | {value} |" for name, value in plain.items()]
    return "\n".join([f"## {title}\n", "| figure | value |", "|---|---|", *rows, ""])
