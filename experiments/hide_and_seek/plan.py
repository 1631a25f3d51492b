"""Which rounds a suite plays, and where. Pure."""

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

from services.launcher.client.run_record import world_label

THESIS_ROUNDS = {"village": 5, "apartment": 3, "break_room": 3, "factory": 3}
"""Rounds of the thesis's section 6, by world."""

SUITES = ("thesis", "random")
MAP_SEED = 1
"""Of every suite's maps: runs of different seeds play on the same ones."""


def folder_of(what: str, pipeline: str | None, profile: str | None) -> str:
    """Name of the folder in which something is kept: of each pipeline and profile its own."""
    by = pipeline.split("/") if pipeline else []
    return "-".join([what, *by, *([Path(profile).stem] if profile else [])])


@dataclass(frozen=True)
class MapPlan:
    """A map that rounds are played on.

    Attributes:
        world: name, or path of a YAML file.
        pipeline: of the features; None: the default one.
        profile: rules by which it is explored; None: the default ones.
    """

    world: str
    pipeline: str | None = None
    profile: str | None = None

    @property
    def label(self) -> str:
        """Folder name."""
        return folder_of(world_label(self.world), self.pipeline, self.profile)


@dataclass(frozen=True)
class RunPlan:
    """Rounds in one world under one profile, one after the other; the seeker stays where it ended.

    Attributes:
        world: name, or path of a YAML file.
        profile: rules of planner and drive as a command names them.
        max_steps: a round is given up after so many frames.
        draw: draw the plan and the final frames of every round.
        record: keep a recording of every round that fails.
        pipeline: of the features of map and rounds; None: the default one.
        map_profile: rules by which the world is explored; None: the default ones.
    """

    world: str
    profile: str
    rounds: int
    seed: int
    max_steps: int
    draw: bool = True
    record: bool = False
    pipeline: str | None = None
    map_profile: str | None = None

    @property
    def name(self) -> str:
        """Folder name: short and unique within a suite."""
        return f"{self.map.label}-{Path(self.profile).stem}-{self.seed}"

    @property
    def map(self) -> MapPlan:
        """On which the rounds are played."""
        return MapPlan(self.world, self.pipeline, self.map_profile)


def plan_suite(
    suite: str,
    seed: int,
    *,
    rounds: int,
    worlds: Sequence[str] = (),
    profiles: Sequence[str] = ("default",),
    max_steps: int,
    draw: bool = True,
    pipeline: str | None = None,
    map_profile: str | None = None,
) -> list[RunPlan]:
    """All runs of a suite.

    Args:
        suite: 'thesis' (its fourteen rounds) or 'random' (`rounds` in each world).
        seed: of the hiding places.
        rounds: per world, of the random suite.
        worlds: only these; empty for all four.
        profiles: each world is played under each.
        max_steps: bound of a round.
        draw: draw every round.
        pipeline: of the features; None: the default one.
        map_profile: rules by which the worlds are explored; None: the default ones.

    Raises:
        ValueError: an unknown suite, or a world that the thesis has no rounds in.
    """
    if suite not in SUITES:
        raise ValueError(f"suite must be one of {', '.join(SUITES)}, got {suite!r}")
    chosen = list(worlds) or list(THESIS_ROUNDS)
    if suite == "thesis":
        others = [world for world in chosen if world not in THESIS_ROUNDS]
        if others:
            raise ValueError(
                f"the thesis has rounds in {', '.join(THESIS_ROUNDS)}, got {', '.join(others)}: "
                "use --suite random"
            )
    counts = THESIS_ROUNDS if suite == "thesis" else dict.fromkeys(chosen, rounds)
    return [
        RunPlan(
            world, profile, counts[world], seed, max_steps, draw, pipeline=pipeline, map_profile=map_profile
        )
        for profile in dict.fromkeys(profiles)
        for world in chosen
    ]
