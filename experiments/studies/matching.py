"""`topnav study matching`: descriptors, representations and matchers on the sphere (thesis, section 3.1)."""

from pathlib import Path
from typing import Annotated, Any

import cv2
import numpy as np
import typer
from rich.console import Console

from experiments.matching import plan, study
from experiments.matching.measure import measure_pair, words_of
from experiments.matching.pictures import from_folder, rendered
from experiments.matching.placing import UNCHANGED, Change, Image
from experiments.plots.matching import draw_curves, draw_matching
from experiments.studies.page import write_page
from experiments.studies.results_file import ResultsFile
from services.features.pipeline.plugins import CLASSIC
from services.launcher.client.failure import ExperimentError
from services.launcher.terminal import options
from services.launcher.terminal.tables import print_rows, wide_console

TIMED_PX = 2048


def main(
    quick: Annotated[bool, typer.Option("--quick", help="One picture, three latitudes.")] = False,
    full: Annotated[bool, typer.Option("--full", help="Two pictures, nine latitudes.")] = False,
    only: Annotated[str | None, typer.Option(help='Descriptors, as "sift,orb"; default: all.')] = None,
    pictures: Annotated[
        Path | None, typer.Option(help="Folder of pictures instead of rendered views.")
    ] = None,
    timing: Annotated[bool, typer.Option(help="Measure the table of times too.")] = True,
    plots: Annotated[Path | None, typer.Option(help="Draw the curves into this folder.")] = None,
    seed: options.Seed = 1,
    json_file: options.JsonFile = None,
    data_dir: options.DataDir = options.DATA_DIR,
) -> int:
    """Mean average precision over latitude, longitude, blur, rotation and scale.

    Goes on where --json F stopped. Combinations without trained weights are listed, never measured.
    """
    if quick and full:
        raise ExperimentError("--quick and --full exclude each other: choose one")
    size = plan.QUICK if quick else plan.FULL if full else plan.NORMAL
    names = _names(only)
    folder = study.folder_of(data_dir)
    side_px = size.canvas_px // 4
    sources = (
        rendered(size.images, side_px, seed, folder)
        if pictures is None
        else from_folder(pictures, size.images, side_px)
    )
    setup = {
        "seed": seed,
        "canvas_px": size.canvas_px,
        "images": len(sources),
        "latitudes_deg": list(size.latitudes_deg),
    }
    file = ResultsFile(json_file, setup, "timing")
    _measure(file, names, sources, size)
    if timing:
        _time(file, names, rendered(1, TIMED_PX // 4, seed, folder)[0])
    wins = study.tangent_wins(file.results)
    file.write(tangent_wins=wins)
    report = {**file.tables, "tangent_wins": wins}
    if plots is not None:
        for matcher in plan.MATCHERS:
            draw_matching(plots / f"map-{matcher}.png", report["results"], matcher)
        _draw_example(plots, sources[0], size.canvas_px)
        _write_page(plots, report)
    _show(report)
    return len(file.results)


def _measure(file: ResultsFile, names: list[str], sources: list[Image], size: plan.Size) -> None:
    """Rows of all descriptors that the file does not have yet."""
    done = {row["descriptor"] for row in file.results}
    with wide_console(stderr=True).status("") as status:
        for name in names:
            if name in done:
                continue
            rows = []
            for row in study.measured(name, sources, size):
                rows.append(row)
                status.update(f"{name}, {row['representation']}, {row['matcher']}: {row['disturbance']}")
            file.add(*rows)


def _time(file: ResultsFile, names: list[str], view: Image) -> None:
    """Extraction times of a 1024 x 2048 picture full of texture: the view, tiled over the sphere."""
    panorama = np.asarray(cv2.resize(np.tile(view, (2, 4)), (TIMED_PX, TIMED_PX // 2)), np.uint8)
    done = {row["descriptor"] for row in file.tables["timing"]}
    done |= {row["descriptor"] for row in file.results if row["map"] is None}  # no weights here
    for name in names:
        if name in done:
            continue
        row = study.timed(name, panorama, 3 if name in CLASSIC else 1)
        if row is not None:
            file.add(row, table="timing")


def _names(only: str | None) -> list[str]:
    asked = list(plan.DESCRIPTORS) if only is None else [name.strip() for name in only.split(",")]
    wrong = sorted(set(asked) - set(plan.DESCRIPTORS))
    if wrong:
        raise ExperimentError(f"--only knows {', '.join(plan.DESCRIPTORS)}, got {', '.join(wrong)}")
    return asked


def _draw_example(folder: Path, picture: Image, canvas_px: int) -> None:
    curves = []
    for representation in plan.REPRESENTATIONS:
        pipeline = study.pipeline_with_weights("sift", representation, "brute_force")
        assert pipeline is not None
        first, second = (
            words_of(picture, change, pipeline, canvas_px)
            for change in (UNCHANGED, Change("latitude", 45.0, lat_deg=45.0))
        )
        result = measure_pair(first, second, pipeline.extractor.distance, "brute_force")
        curves.append((f"sift, {representation}, 45 deg", result.known))
    draw_curves(folder / "precision-recall.png", curves)


def _write_page(folder: Path, report: dict[str, Any]) -> None:
    """All tables and figures on one page."""
    tables = [
        ("Tangent pictures against the whole canvas beyond 45 degrees of latitude", report["tangent_wins"]),
        ("Extraction of 1024 x 2048 pixels", report["timing"]),
        ("Mean average precision", [row for row in report["results"] if row["map"] is not None]),
        ("Not measured", [row for row in report["results"] if row["map"] is None]),
    ]
    figures = [(f"Mean average precision, {m}", f"map-{m}.png") for m in plan.MATCHERS]
    figures.append(("Precision against recall of one pair", "precision-recall.png"))
    write_page(
        folder,
        "matching",
        "Descriptors on the sphere",
        "topnav study matching --plots FOLDER",
        tables,
        figures,
    )


def _show(report: dict[str, Any]) -> None:
    keys = (
        "descriptor",
        "representation",
        "matcher",
        "disturbance",
        "level",
        "map",
        "map_ransac",
        "keypoints",
    )
    rows = [row for row in report["results"] if row["map"] is not None and row["disturbance"] == "latitude"]
    print_rows("mean average precision over latitude", [{key: row[key] for key in keys} for row in rows])
    print_rows("tangent pictures beyond 45 degrees", report["tangent_wins"])
    if report["timing"]:
        print_rows("extraction of 1024 x 2048 pixels", report["timing"])
    missing = sorted({row["descriptor"] for row in report["results"] if row["map"] is None})
    if missing:
        Console().print(f"no weights here, not measured: {', '.join(missing)}")
