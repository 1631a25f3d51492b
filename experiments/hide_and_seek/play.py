"""Rounds of hide and seek one after the other, each drawn and told."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np
from rich.console import Console

from experiments.hide_and_seek.recorded import played_on_record
from services.launcher.client.environments import environment_of
from services.launcher.client.maps import require_map
from services.launcher.client.stack import Stack
from services.launcher.evaluation.outcome import Round, draw_round
from services.launcher.evaluation.rounds import Game, hiding_place
from services.launcher.evaluation.truth_file import MapTruth
from services.launcher.terminal.output import wide_console
from services.launcher.terminal.progress import mission_progress
from shared.messages.simulation import Pose
from simulator.world.freespace import free_space
from simulator.world.world_file import WorldFile


@dataclass(frozen=True)
class Scene:
    """Where the rounds take place; `truth` is for the drawings only."""

    world: WorldFile
    map_name: str
    truth: MapTruth | None


def play_rounds(
    stack: Stack,
    scene: Scene,
    rounds: int,
    seed: int,
    max_steps: int,
    folder: Path | None,
    before: Sequence[dict[str, Any]] = (),
    *,
    recordings: Path | None = None,
    quiet: bool = False,
) -> Iterator[dict[str, Any]]:
    """Play one round after the other; the seeker stays where the last one ended.

    Args:
        stack: services that know the map.
        scene: world and map.
        rounds: how many there are in all.
        seed: of hiding places and missions.
        max_steps: bound of a round.
        folder: for the drawings, or None.
        before: figures of the rounds already played; only the others are.
        recordings: folder for recordings of the rounds that fail, or None.
        quiet: print nothing.

    Yields:
        Figures of each round.
    """
    console = Console(quiet=True) if quiet else wide_console(stderr=True)
    require_map(stack, scene.map_name)
    place, space = environment_of(scene.world), free_space(scene.world)
    rng = np.random.default_rng(seed)
    game = Game(stack, space, scene.map_name, rng, place.arrived_m)
    game.begin(seed)
    done = [dict(one) for one in before]  # the caller may append what this yields
    for one in done:
        hiding_place(space, Pose.model_validate(one["start"]), rng)
    if done:
        game.experimenter.place_robot(Pose.model_validate(done[-1]["final"]))
    poses = scene.truth.poses if scene.truth is not None else {}
    for number in range(len(done) + 1, rounds + 1):
        title = f"{scene.world.name} round {number}/{rounds}"
        play = partial(play_told, console, game, title, seed + number, max_steps)
        played = played_on_record(stack, recordings and recordings / f"round-{number:02d}.mcap", play)
        if folder is not None:
            edges = require_map(stack, scene.map_name).edges
            views = game.final_views(played.hider)
            draw_round(folder / f"round-{number:02d}", scene.world, played, poses, edges, views)
        yield played.figures()


def play_told(console: Console, game: Game, title: str, seed: int, max_steps: int) -> Round:
    """Play one round with its progress on the console, and a line about its end."""
    with mission_progress(console, title) as watch:
        played = game.play(seed, max_steps, watch)
    verdict = "found" if played.success else "NOT found"
    console.print(
        f"{title}: {verdict}, {played.distance_m:.2f} m left, SPL {played.spl:.2f}, "
        f"{played.run.status.step} steps, {played.run.steps_per_s:.1f} steps/s: {played.run.status.reason}",
        highlight=False,
    )
    return played
