"""What `topnav study matching` measured: figures, a page, and what people look for first."""

from pathlib import Path
from typing import Any

from experiments.matching.drawing import draw_curves, draw_matching
from experiments.matching.measure import extracted, measure_pair
from experiments.matching.placing import UNCHANGED, Change, Image
from experiments.matching.plan import MATCHERS, REPRESENTATIONS
from experiments.matching.study import pipeline_with_weights
from experiments.work.page import write_page
from services.launcher.terminal.output import print_rows, wide_console

SHOWN = (
    "descriptor",
    "representation",
    "matcher",
    "disturbance",
    "level",
    "map",
    "map_ransac",
    "keypoints",
)


def draw(folder: Path, report: dict[str, Any], picture: Image, canvas_px: int) -> None:
    """All figures, and a page of tables and figures."""
    measured = [row for row in report["results"] if row["map"] is not None]
    for matcher in MATCHERS:
        draw_matching(folder / f"map-{matcher}.png", measured, matcher)
    _draw_example(folder / "precision-recall.png", picture, canvas_px)
    tables = [
        ("Tangent pictures against the whole canvas beyond 45 degrees of latitude", report["tangent_wins"]),
        ("Extraction of 1024 x 2048 pixels", report["timing"]),
        ("Mean average precision", measured),
        ("Not measured", [row for row in report["results"] if row["map"] is None]),
    ]
    figures = [(f"Mean average precision, {m}", f"map-{m}.png") for m in MATCHERS]
    figures.append(("Precision against recall of one pair", "precision-recall.png"))
    command = "topnav study matching --plots FOLDER"
    write_page(folder, "matching", "Descriptors on the sphere", command, tables, figures)


def show(report: dict[str, Any]) -> None:
    """Print the means over latitude, verdicts and times."""
    rows = [row for row in report["results"] if row["map"] is not None and row["disturbance"] == "latitude"]
    print_rows("mean average precision over latitude", rows, SHOWN)
    print_rows("tangent pictures beyond 45 degrees", report["tangent_wins"])
    if report["timing"]:
        print_rows("extraction of 1024 x 2048 pixels", report["timing"])
    missing = sorted({row["descriptor"] for row in report["results"] if row["map"] is None})
    if missing:
        wide_console().print(f"no weights here, not measured: {', '.join(missing)}")


def _draw_example(path: Path, picture: Image, canvas_px: int) -> None:
    curves = []
    for representation in REPRESENTATIONS:
        pipeline = pipeline_with_weights("sift", representation, "brute_force")
        assert pipeline is not None
        first, second = (
            extracted(picture, change, pipeline, canvas_px)
            for change in (UNCHANGED, Change("latitude", 45.0, lat_deg=45.0))
        )
        result = measure_pair(first, second, pipeline.extractor.distance, "brute_force")
        curves.append((f"sift, {representation}, 45 deg", result.known))
    draw_curves(path, curves)
