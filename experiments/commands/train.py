"""`topnav train`: pairs from rendered worlds, our own features and matcher, and what they are worth."""

from pathlib import Path
from typing import Annotated

import typer

from services.launcher.terminal import options

app = typer.Typer(
    name="train", no_args_is_help=True, help="Train features and a matcher of our own on rendered worlds."
)

WORLDS, SHARDS, PAIRS = 40, 4, 64  # 10,240 pairs, some 10 GB
JUDGED = (
    "sift,aliked-t16,aliked-n16,sift/equirectangular/topnav-attention,topnav-keypoints,topnav-slim,"
    "topnav-hardnet,topnav-sift-slim,topnav-sift-hardnet"
)
DATA, MODELS = Path("data/training/pairs"), Path("data/training")
RecipeFile = Annotated[
    Path | None, typer.Option("--recipe", help="JSON with values that replace the recipe's.")
]
Device = Annotated[str, typer.Option(help="cpu or cuda.")]
Export = Annotated[Path | None, typer.Option(help="Write the trained weights alone into this file.")]
Jobs = Annotated[int, typer.Option(min=1, help="Worlds at a time.")]
ShardsAtATime = Annotated[int, typer.Option("--jobs", min=1, help="Shards read at a time.")]
Shards = Annotated[Path, typer.Option(help="Folder of shards of 'topnav train data'.")]
Checkpoints = Annotated[Path, typer.Option(help="Folder of checkpoints and log.")]
Until = Annotated[int | None, typer.Option(min=1, help="Stop early after this step.")]


@app.command("data")
def data(
    into: Annotated[Path, typer.Option(help="Folder of the shards.")] = DATA,
    worlds: Annotated[int, typer.Option(min=1, help="Development worlds, kinds and sizes in turn.")] = WORLDS,
    only: Annotated[
        str, typer.Option(help='Worlds by name, as "hostel-0-medium,school-0-small", instead.')
    ] = "",
    shards: Annotated[int, typer.Option(min=1, help="Per world, each in its own light.")] = SHARDS,
    pairs: Annotated[int, typer.Option(min=1, help="Per shard.")] = PAIRS,
    draw: Annotated[Path | None, typer.Option(help="Draw some pairs with lines into this picture.")] = None,
    recipe: RecipeFile = None,
    jobs: Jobs = 1,
    seed: Annotated[int | None, typer.Option(min=0, help="Of every draw; default: the recipe's.")] = None,
) -> None:
    """Pairs with exact correspondences, from development worlds only; goes on where it stopped."""
    from experiments.training.data.drawing import draw_pairs, require_picture_name
    from experiments.training.data.drawn import make_missing, plan_shards
    from experiments.training.data.recipe import DataRecipe
    from experiments.training.data.shards import about_shard, trainable
    from experiments.training.recipe import recipe_from
    from experiments.training.worlds import TRAINED_ON, WorldName, first_worlds, require_trainable
    from services.launcher.terminal.output import print_figures

    chosen = recipe_from(DataRecipe, recipe, seed=seed)
    named = [WorldName.parse(name.strip()) for name in only.split(",") if name.strip()]
    names = named or first_worlds(TRAINED_ON, worlds)
    require_trainable(names, "train data")
    plans = plan_shards(names, TRAINED_ON, shards, pairs, chosen, into)
    if draw is not None:
        require_picture_name(draw)
    made = make_missing(plans, jobs)
    found = [plan.done for plan in plans if plan.done is not None]
    if draw is not None:
        draw_pairs(draw, [pair for path in found[:4] for pair in trainable(path).pairs[:2]], chosen.seed)
    figures = {"folder": str(into), "shards": len(found), "made now": len(made)}
    count = sum(about_shard(path)["pairs"] for path in found)
    bytes_ = sum(path.stat().st_size for path in found)
    print_figures("pairs to train on", {**figures, "pairs": count, "megabytes": round(bytes_ / 1e6)})


@app.command("residual")
def residual(
    pairs: Shards = DATA,
    into: Checkpoints = MODELS / "residual",
    recipe: RecipeFile = None,
    until: Until = None,
) -> None:
    """A residual on root SIFT; goes on from the last checkpoint to the same result as if never cut off."""
    from experiments.training.recipe import recipe_from
    from experiments.training.residual.recipe import ResidualRecipe
    from experiments.training.residual.training import train
    from services.launcher.terminal.output import print_figures

    print_figures("residual", train(pairs, into, recipe_from(ResidualRecipe, recipe), until))


@app.command("keypoints")
def keypoints(
    pairs: Shards = DATA,
    into: Checkpoints = MODELS / "keypoints",
    recipe: RecipeFile = None,
    until: Until = None,
    device: Device = "cpu",
    export: Export = None,
    jobs: ShardsAtATime = 1,
) -> None:
    """Detector and descriptor in one pass; goes on from the last checkpoint."""
    from experiments.training.detector.recipe import KeypointsRecipe
    from experiments.training.detector.training import train
    from experiments.training.recipe import recipe_from
    from services.launcher.terminal.output import print_figures

    chosen = recipe_from(KeypointsRecipe, recipe)
    print_figures("keypoints", train(pairs, into, chosen, device, until, export, jobs))


@app.command("matcher")
def matcher(
    pairs: Shards = DATA,
    into: Checkpoints = MODELS / "matcher",
    detector: Annotated[
        Path, typer.Option(help="Folder of 'topnav train keypoints', for a recipe with features own.")
    ] = MODELS / "keypoints",
    recipe: RecipeFile = None,
    until: Until = None,
    device: Device = "cpu",
    export: Export = None,
    jobs: ShardsAtATime = 1,
) -> None:
    """Attention over the keypoints of two pictures; goes on from the last checkpoint."""
    from experiments.training.matcher.recipe import MatcherRecipe
    from experiments.training.matcher.training import train
    from experiments.training.recipe import recipe_from
    from services.launcher.terminal.output import print_figures

    chosen = recipe_from(MatcherRecipe, recipe)
    print_figures("matcher", train(pairs, into, detector, chosen, device, until, export, jobs))


@app.command("patch")
def patch(
    shape: Annotated[str | None, typer.Option(help="hardnet, sosnet or slim; default: the recipe's.")] = None,
    pairs: Shards = DATA,
    into: Checkpoints = MODELS / "patch",
    recipe: RecipeFile = None,
    until: Until = None,
    device: Device = "cpu",
    jobs: ShardsAtATime = 1,
    export: Export = None,
) -> None:
    """A descriptor of patches; goes on from the last checkpoint, on the CPU to the same bits."""
    from experiments.training.data.shards import shard_files
    from experiments.training.learning.export import exported
    from experiments.training.patch.recipe import PatchRecipe
    from experiments.training.patch.training import about, read, train
    from experiments.training.recipe import recipe_from
    from services.features.networks.runtime import device_named
    from services.launcher.terminal.output import print_figures

    chosen = recipe_from(PatchRecipe, recipe, shape=shape)
    place, files = device_named(device), shard_files(pairs)
    patches = read(files, into, chosen, jobs)
    network, reached = train(patches, chosen, into, place, until)
    figures = {"folder": str(into), "pairs of patches": len(patches), "steps": reached}
    if export is not None:
        figures["exported bytes"] = exported(network, export, about(chosen, reached, files))
    print_figures("patch", figures)


@app.command("evaluate")
def evaluate(
    models: Annotated[str, typer.Option(help="Pipelines to judge.")] = JUDGED,
    trained: Annotated[
        Path | None, typer.Option(help="A folder of 'topnav train residual' to judge, too.")
    ] = None,
    photographs: Annotated[
        Path | None, typer.Option(help="Folder of tours to judge on as well, see deploy/PHOTOGRAPHS.md.")
    ] = None,
    into: Annotated[Path, typer.Option(help="Folder of the pairs it is judged on.")] = MODELS / "judged",
    worlds: Annotated[int, typer.Option(min=1, help="Validation worlds, kinds and sizes in turn.")] = 10,
    pairs: Annotated[int, typer.Option(min=1, help="Per world, 0.3 to 6 m apart.")] = 20,
    jobs: Jobs = 1,
    seed: options.Seed = 1,
    json_file: options.JsonFile = None,
) -> None:
    """Ours and others on the same pairs of validation worlds, as the simulated camera takes them."""
    from experiments.photographs.tours import read_tours
    from experiments.training.data.drawn import make_missing, plan_shards
    from experiments.training.data.recipe import DataRecipe
    from experiments.training.data.shards import read_shard
    from experiments.training.evaluation.measure import as_written, judge
    from experiments.training.evaluation.models import available, trained_residual
    from experiments.training.evaluation.photographs import judge_photographs
    from experiments.training.worlds import first_worlds
    from services.launcher.terminal.output import print_rows, write_json

    ours = [trained_residual(trained)] if trained is not None else []
    found, absent = available([name.strip() for name in models.split(",") if name.strip()])
    tours = read_tours(photographs) if photographs is not None else []
    recipe = DataRecipe.plain(seed, (0.3, 6.0))
    plans = plan_shards(first_worlds("validation", worlds), "validation", 1, pairs, recipe, into)
    make_missing(plans, jobs)
    judged = [pair for plan in plans if plan.done is not None for pair in read_shard(plan.done).pairs]
    rows = [judge(model, judged) for model in (*found, *ours)]
    taken = {model.name: judge_photographs(model.name, tours, seed, jobs) for model in found if tours}
    write_json(
        json_file,
        {
            "pairs": len(judged),
            "seed": seed,
            "models": [as_written(row, taken.get(row["name"])) for row in rows],
            "without_weights": absent,
        },
    )
    print_rows("on validation worlds", rows)
    if taken:
        print_rows("on photographs", [{"name": name} | row for name, row in taken.items()])
    if absent:
        print_rows("without weights", [{"name": name, "why": why} for name, why in absent.items()])
