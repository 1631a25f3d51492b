"""Hide and seek on a clean map while camera and world are disturbed: the rounds of one level."""

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from experiments.hide_and_seek.play import play_told
from experiments.hide_and_seek.report import summary
from experiments.rendered.disturbed import CLEAN, disturbances
from experiments.work.page import line_style, new_figure
from experiments.work.results_file import Row
from services.launcher.client.failure import ExperimentError
from services.launcher.client.maps import require_map
from services.launcher.client.stack import StackChoice, open_stack
from services.launcher.drawing.pictures import save_figure
from services.launcher.evaluation.rounds import Game
from services.launcher.processes.state import StateFolder
from services.launcher.terminal.output import wide_console
from simulator.disturbances.levels import Disturbances
from simulator.disturbances.rearranging import rearranged
from simulator.world.changes import changed_world
from simulator.world.freespace import free_space
from simulator.world.world_file import WorldFile, load_world

MEASURES = (("success_rate", "success rate"), ("spl_mean", "mean SPL"))


@dataclass(frozen=True)
class Study:
    """What all levels share."""

    world: str
    map_name: str
    rounds: int
    seed: int
    max_steps: int
    data_dir: Path

    def setup(self) -> Row:
        """The options that all rows of its results file share.

        Raises:
            ExperimentError: a stack runs in its folder.
        """
        if StateFolder(self.data_dir.resolve()).read() is not None:
            raise ExperimentError("a stack runs there: stop it ('topnav down'), every setting needs its own")
        kept = ("world", "map_name", "seed", "rounds", "max_steps")
        return {name.removesuffix("_name"): getattr(self, name) for name in kept}


def settings_to_run(names: Iterable[str], levels: Iterable[float], results: list[Row]) -> list[Row]:
    """Pairs of disturbance and level without a result; level 0 is one run for all of them."""
    wanted: list[tuple[str, float]] = []
    for level in sorted(set(levels)):
        wanted += [(CLEAN, 0.0)] if level == 0.0 else [(name, level) for name in names]
    done = {(row["disturbance"], row["level"]) for row in results}
    return [{"disturbance": name, "level": level} for name, level in wanted if (name, level) not in done]


def run_level(study: Study, disturbance: str, level: float) -> Row:
    """Start a stack with one disturbance at a level and play the rounds."""
    rounds = play(study, f"{disturbance} {level:g}", disturbances(disturbance, level), {})
    return level_row(disturbance, level, rounds)


def play(study: Study, label: str, levels: Disturbances, environment: Mapping[str, str]) -> list[Row]:
    """The figures of the rounds in a stack of their own.

    Args:
        study: which rounds.
        label: what people are told beside the number of a round.
        levels: of the disturbances.
        environment: further settings of the services.
    """
    console = wide_console(stderr=True)
    choice = StackChoice(
        study.data_dir,
        study.world,
        study.seed,
        lockstep=True,
        environment={"SIMULATOR_DISTURBANCE": levels.text(), **environment},
    )
    clean = load_world(study.world)
    space, mapped = free_space(true_world(clean, levels, study.seed)), free_space(clean)
    # Where furniture stood while the map was made, no node of the map need be near.
    hideouts = replace(space, free=space.free & mapped.free)
    with open_stack(choice) as stack:
        require_map(stack, study.map_name)
        rng = np.random.default_rng(study.seed)
        game = Game(stack, space, study.map_name, rng, hideouts=hideouts)
        game.begin(study.seed)
        played = [
            play_told(console, game, f"{label}: {n}/{study.rounds}", study.seed + n, study.max_steps)
            for n in range(1, study.rounds + 1)
        ]
    return [one.figures() for one in played]


def level_row(disturbance: str, level: float, rounds: list[Row]) -> Row:
    """One entry of "results" from the figures of its rounds; the keys up to rounds are fixed."""
    failures, whole = [str(one["failure"]) for one in rounds if one["failure"]], summary(rounds)
    return {
        "disturbance": disturbance,
        "level": level,
        "success_rate": whole["success_rate"],
        "spl_mean": whole["spl_mean"],
        "rounds": len(rounds),
        "final_distance_m_median": whole["final_distance_median_m"],
        "collisions": whole["collisions"],
        "failures": {name: failures.count(name) for name in sorted(set(failures))},
        "each": rounds,
    }


def true_world(world: WorldFile, levels: Disturbances, seed: int) -> WorldFile:
    """The world as the simulator has it: hiders must not be put into furniture that was moved."""
    return changed_world(world, rearranged(world, levels.furniture, seed))


def draw_curves(path: Path, results: list[Row]) -> None:
    """Draw one curve per disturbance in both measures; the clean result is the start of all of them.

    Args:
        path: PNG to write.
        results: entries with disturbance, level, success_rate and spl_mean.
    """
    figure = new_figure(10.0, 4.4)
    start = [row for row in results if row["disturbance"] == CLEAN]
    names = list(dict.fromkeys(row["disturbance"] for row in results if row["disturbance"] != CLEAN))
    for axes, (key, title) in zip(figure.subplots(1, 2, sharey=True), MEASURES, strict=True):
        for number, name in enumerate(names):
            rows = sorted(
                [*start, *(r for r in results if r["disturbance"] == name)], key=lambda row: row["level"]
            )
            levels = [row["level"] for row in rows]
            axes.plot(levels, [row[key] for row in rows], label=name, **line_style(number))
        if not names:
            axes.plot([0.0] * len(start), [row[key] for row in start], "ko", label=CLEAN)
        axes.axhline(0.9, color="0.7", linestyle=":") if key == "success_rate" else None
        axes.set(xlabel="level", title=title, xlim=(-0.03, 1.03), ylim=(-0.03, 1.05))
        axes.grid(alpha=0.3)
    figure.axes[1].legend(loc="lower left", fontsize=8)
    save_figure(figure, path)
