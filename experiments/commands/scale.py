"""`topnav study scale`: cost and recall as a map grows from 100 to 100,000 nodes; load as robots do."""

from pathlib import Path
from typing import Annotated, Any

import typer

from experiments.work.record import on_record
from services.launcher.terminal import options

app = typer.Typer()

SIZES, QUICK_SIZES = (100, 1000, 10_000, 100_000), (100, 300)
FLEETS, QUICK_FLEETS = (1, 2, 4, 8, 16), (1, 2)


@app.command("scale")
@on_record("study scale")
def scale(
    quick: Annotated[bool, typer.Option("--quick", help="Maps of 100 and 300 nodes.")] = False,
    sizes: Annotated[str | None, typer.Option(help='Nodes of the maps, as "100,1000".')] = None,
    robots: Annotated[str | None, typer.Option(help='Robots that ask at once, as "1,4".')] = None,
    plot: Annotated[Path | None, typer.Option(help="Draw the growth into this PNG.")] = None,
    seed: options.Seed = 1,
    pipeline: options.PipelineName = None,
    json_file: options.JsonFile = None,
    data_dir: options.DataDir = options.DATA_DIR,
) -> int:
    """Growth of the time to find a node, of memory and of loading; others on the same pictures; robots."""
    from experiments.scale.drawing import draw_growth
    from experiments.scale.report import measure
    from services.launcher.client.failure import one_line_errors
    from services.launcher.terminal.output import print_rows, wide_console, write_json

    counts = [int(size) for size in sizes.split(",")] if sizes else list(QUICK_SIZES if quick else SIZES)
    fleets = [int(size) for size in robots.split(",")] if robots else list(QUICK_FLEETS if quick else FLEETS)
    cache = data_dir / "cache"
    report: dict[str, Any] = {}
    with wide_console(stderr=True).status("") as status, one_line_errors():
        for report in measure(counts, fleets, pipeline or "sift", seed, cache, quick, status.update):
            write_json(json_file, report)
    if plot is not None:
        draw_growth(plot, report["points"], report["robots"])
    print_rows("maps that grow", report["points"])
    print_rows("on the same pictures", report["peers"])
    print_rows("matches lost by packing", report["packing"])
    print_rows("not in this map", [{k: v for k, v in report["refusal"].items() if k != "curve"}])
    print_rows("robots that ask at once", report["robots"])
    return len(report["points"])
