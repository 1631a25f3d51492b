"""`topnav train`: pairs from rendered worlds, our own features and matcher, and what they are worth."""

from pathlib import Path
from typing import Annotated

import typer

app = typer.Typer(
    name="train", no_args_is_help=True, help="Train features and a matcher of our own on rendered worlds."
)

WORLDS, SHARDS, PAIRS = 40, 4, 64  # 10,240 pairs, some 10 GB
DATA, MODELS = Path("data/training/pairs"), Path("data/training")
RecipeFile = Annotated[
    Path | None, typer.Option("--recipe", help="JSON with values that replace the recipe's.")
]
Jobs = Annotated[int, typer.Option(min=1, help="Worlds at a time.")]


@app.command("data")
def data(
    into: Annotated[Path, typer.Option(help="Folder of the shards.")] = DATA,
    worlds: Annotated[int, typer.Option(min=1, help="Development worlds, kinds and sizes in turn.")] = WORLDS,
    only: Annotated[str, typer.Option(help='Worlds by name, as "flat-3-small,shop-0-small", instead.')] = "",
    shards: Annotated[int, typer.Option(min=1, help="Per world, each in its own light.")] = SHARDS,
    pairs: Annotated[int, typer.Option(min=1, help="Per shard.")] = PAIRS,
    draw: Annotated[Path | None, typer.Option(help="Draw some pairs with lines into this picture.")] = None,
    recipe: RecipeFile = None,
    jobs: Jobs = 1,
    seed: Annotated[int | None, typer.Option(min=0, help="Of every draw; default: the recipe's.")] = None,
) -> None:
    """Pairs with exact correspondences, from development worlds only; goes on where it stopped."""
    from experiments.training.data.drawing import draw_pairs
    from experiments.training.data.drawn import make_missing, plan_shards
    from experiments.training.data.recipe import DataRecipe
    from experiments.training.data.shards import trainable
    from experiments.training.recipe import recipe_from
    from experiments.training.worlds import TRAINED_ON, WorldName, first_worlds, require_trainable
    from services.launcher.terminal.output import print_figures

    chosen = recipe_from(DataRecipe, recipe, seed=seed)
    named = [WorldName.parse(name.strip()) for name in only.split(",") if name.strip()]
    names = named or first_worlds(TRAINED_ON, worlds)
    require_trainable(names, "train data")
    plans = plan_shards(names, TRAINED_ON, shards, pairs, chosen, into)
    made = make_missing(plans, jobs)
    found = [trainable(plan.done) for plan in plans if plan.done is not None]
    if draw is not None:
        some = [pair for shard in found for pair in shard.pairs[:2]]
        draw_pairs(draw, some[:8], chosen.seed)
    figures = {"folder": str(into), "shards": len(found), "made now": len(made)}
    count = sum(len(shard.pairs) for shard in found)
    bytes_ = sum(plan.done.stat().st_size for plan in plans if plan.done is not None)
    print_figures("pairs to train on", {**figures, "pairs": count, "megabytes": round(bytes_ / 1e6)})
