"""One shard: a world drawn, two photographers in it, pairs taken and degraded. A function of values."""

from dataclasses import dataclass
from pathlib import Path
from typing import Any

import cv2
import numpy as np

from experiments.rendered.pairs import PosePair
from experiments.training.data.alike import draw_strangers
from experiments.training.data.degrading import degraded, drawn
from experiments.training.data.recipe import DataRecipe
from experiments.training.data.shards import SUFFIX, Pair, Shard, write_shard
from experiments.training.photographing import Conditions, Photographer, draw_apart, draw_tilt
from experiments.training.sealed import sealed_files
from experiments.training.sights import Sight, overlap
from experiments.training.worlds import WorldName
from services.launcher.client.failure import ExperimentError
from simulator.generation.splits import Split
from simulator.world.freespace import FreeSpace, free_space
from simulator.world.world_file import WorldFile


@dataclass(frozen=True)
class ShardPlan:
    """One shard.

    Attributes:
        world: a generated one.
        split: of which it must be.
        number: of the shard among those of its world.
        pairs: how many.
        recipe: how they are drawn.
        folder: where it is kept.
    """

    world: WorldName
    split: Split
    number: int
    pairs: int
    recipe: DataRecipe
    folder: str

    @property
    def stem(self) -> str:
        """Of the file's name."""
        return f"{self.world}-{self.number:03d}"

    @property
    def about(self) -> dict[str, Any]:
        """What stands in the shard: all that its pairs depend on."""
        return {
            "split": self.split,
            "number": self.number,
            "planned": self.pairs,
            "recipe": self.recipe.model_dump(mode="json"),
        }

    @property
    def done(self) -> Path | None:
        """The shard if an earlier run finished it."""
        return next(iter(sealed_files(Path(self.folder), self.stem, SUFFIX)), None)


def make_shard(plan: ShardPlan) -> int:
    """Draw, take, degrade and keep the pairs of a shard.

    Returns:
        How many pairs it has; fewer than planned where the world has no room for them.

    Raises:
        ExperimentError: the world is not of the split that was asked for.
    """
    if plan.world.split != plan.split:
        raise ExperimentError(
            f"world {plan.world} is of the {plan.world.split} split, {plan.split} was asked for"
        )
    recipe, world = plan.recipe, plan.world.world()
    rng = np.random.default_rng([recipe.seed, plan.number, *str(plan.world).encode()])
    ends = _conditions(recipe, rng)
    space = free_space(world)
    poses = [pair for _ in range(plan.pairs) if (pair := _draw(world, space, recipe, rng)) is not None]
    sights: list[list[Sight]] = []
    for conditions, taken_at in zip(
        ends, ([pair.current for pair in poses], [pair.target for pair in poses]), strict=True
    ):
        photographer = Photographer(world, conditions, recipe.width_px)
        sights.append([photographer.sight(pose, draw_tilt(rng, recipe.tilt_rad)) for pose in taken_at])
    pairs = [Pair(one, two, (overlap(one, two), overlap(two, one))) for one, two in zip(*sights, strict=True)]
    jpegs = [_delivered(sight, recipe, rng) for pair in pairs for sight in (pair.here, pair.there)]
    write_shard(Path(plan.folder), plan.stem, Shard(plan.world, pairs, plan.about), jpegs)
    return len(pairs)


def _conditions(recipe: DataRecipe, rng: np.random.Generator) -> tuple[Conditions, Conditions]:
    """Of both ends: other light in half of the shards, moved furniture in a third of them."""
    middle, off = recipe.height_m
    heights = middle + off * rng.uniform(-1.0, 1.0, 2)
    first, second = recipe.illumination * rng.random(2)
    second = second if rng.random() < 0.5 else first
    moved = recipe.furniture if rng.random() < 1.0 / 3.0 else 0.0
    seed = int(rng.integers(2**31))
    return (
        Conditions(float(heights[0]), float(first)),
        Conditions(float(heights[1]), float(second), moved, seed),
    )


def _draw(
    world: WorldFile, space: FreeSpace, recipe: DataRecipe, rng: np.random.Generator
) -> PosePair | None:
    strangers = draw_strangers(world, space, rng) if rng.random() < recipe.negatives else None
    return strangers or draw_apart(space, rng, recipe.apart_m)


def _delivered(sight: Sight, recipe: DataRecipe, rng: np.random.Generator) -> bytes:
    how = drawn(recipe, rng)
    packed, data = cv2.imencode(
        ".jpg", degraded(sight.picture, how, rng), [cv2.IMWRITE_JPEG_QUALITY, how.quality]
    )
    assert packed, "OpenCV packs any picture of bytes as JPEG"
    return bytes(data)
