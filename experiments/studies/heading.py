"""`topnav study heading`: the Monte Carlo comparison of the heading methods (thesis 3.2), and more."""

from functools import partial
from pathlib import Path
from typing import Annotated, Any, Literal

import typer

from experiments.monte_carlo import examples, study
from experiments.monte_carlo.claims import CLAIMS, Figures, judged
from experiments.monte_carlo.scene import PLACEMENTS, Placement
from experiments.monte_carlo.tracking import DEG
from experiments.monte_carlo.work import results_of
from experiments.plots import heading_examples as drawings
from experiments.studies.page import write_page
from services.launcher.client.failure import ExperimentError
from services.launcher.terminal import options
from services.launcher.terminal.output import write_json
from services.launcher.terminal.tables import print_rows, wide_console

Part = Literal["ahae", "dcpe", "noise", "sweep", "examples"]
UNITS = (("ahae", "deg"), ("dcpe", "pct"))
PARTS: tuple[Part, ...] = ("ahae", "dcpe", "noise", "sweep", "examples")


def main(
    quick: Annotated[bool, typer.Option("--quick", help="A glimpse in less than a minute.")] = False,
    full: Annotated[bool, typer.Option("--full", help="The thesis's 100 scenes of 2000 runs.")] = False,
    only: Annotated[str | None, typer.Option(help=f'Parts, as "ahae,dcpe"; of {", ".join(PARTS)}.')] = None,
    gain: Annotated[
        float, typer.Option(min=0.01, help="Of exp in methods 2, 4, 5 and 6, per radian; 57.3 is per degree.")
    ] = DEG,
    device: Annotated[str, typer.Option(help="Where paths are tracked: cpu or cuda.")] = "cpu",
    cluster: Annotated[str | None, typer.Option(help="Dask scheduler, for example tcp://host:8786.")] = None,
    jobs: Annotated[int | None, typer.Option(min=1, help="Processes; default: all cores.")] = None,
    plots: Annotated[Path | None, typer.Option(help="Draw the figures into this folder.")] = None,
    seed: options.Seed = 1,
    json_file: options.JsonFile = None,
    data_dir: options.DataDir = options.DATA_DIR,
) -> int:
    """Heading errors (AHAE) and detours (DCPE) of all methods in random scenes.

    Finished scenes are kept: a study cut off goes on where it was.
    """
    if quick and full:
        raise ExperimentError("--quick and --full exclude each other: choose one")
    if device not in ("cpu", "cuda"):
        raise ExperimentError(f"--device must be cpu or cuda, got {device!r}")
    parts = _parts(only)
    size = study.QUICK if quick else study.FULL if full else study.NORMAL
    work = partial(
        results_of,
        folder=data_dir / "studies" / "heading",
        console=wide_console(stderr=True),
        cluster=cluster,
        jobs=jobs,
    )
    report, measured = _measure(parts, size, seed, work, gain, device)
    if plots is not None:
        for name, unit in (("ahae", "deg"), ("dcpe", "%")):
            if name in measured:
                study.draw(plots, name.upper(), unit, measured[name])
        if "examples" in parts:
            _draw_examples(plots)
        _write_page(plots, report)
    if json_file is not None:
        write_json(json_file, report)
    _show(report)
    return sum(len(rows) for rows in report.values() if isinstance(rows, list))


def _measure(
    parts: tuple[Part, ...], size: study.Size, seed: int, work: study.Worker, gain: float, device: str
) -> tuple[dict[str, Any], dict[str, Figures]]:
    report: dict[str, Any] = {"seed": seed, "scenes": size.scenes, "ahae_runs": size.ahae_runs, "gain": gain}
    measured: dict[str, Figures] = {}
    if "ahae" in parts:
        measured["ahae"] = study.ahae(size, seed, work, gain)
        report["ahae"] = [row for p, s in measured["ahae"].items() for row in s.rows(p, "deg")]
    if "dcpe" in parts:
        measured["dcpe"] = study.dcpe(size, seed, work, gain, device)
        report["dcpe"] = [row for p, s in measured["dcpe"].items() for row in s.rows(p, "pct")]
        report |= {"dcpe_scenes": size.dcpe_scenes, "dcpe_runs": size.dcpe_runs}
    if measured:
        report["orderings"] = judged(CLAIMS, measured)
    if "noise" in parts:
        report["noise"], report["epipolar_dcpe"] = study.noise(size, seed, work)
    if "sweep" in parts:
        report["sweep"] = study.sweep(size, seed, work)
    return report, measured


def _parts(only: str | None) -> tuple[Part, ...]:
    asked = PARTS if only is None else tuple(part.strip() for part in only.split(","))
    wrong = sorted(set(asked) - set(PARTS))
    if wrong:
        raise ExperimentError(f"--only knows {', '.join(PARTS)}, got {', '.join(wrong)}")
    return tuple(part for part in PARTS if part in asked)


def _draw_examples(folder: Path) -> None:
    drawings.draw_pair_cloud(folder / "pair-growth-and-heading.png", examples.pair_cloud("centre", 1))
    drawings.draw_latitude_case(folder / "latitude-decrease.png", examples.latitude_case("centre", 4))
    cases: tuple[tuple[str, Placement], ...] = (("2", "north"), ("1", "north_east"))
    for method, placement in cases:
        failed = examples.failed_path(method, placement, 1)
        if failed is not None:
            title = f"method {method}, target in the {placement.replace('_', '-')}"
            drawings.draw_failed_path(folder / f"failed-path-method-{method}.png", failed, title)


def _write_page(folder: Path, report: dict[str, Any]) -> None:
    """All tables and figures on one page."""
    wide = [(f"Mean {name.upper()}", _wide(report.get(name, []), f"mean_{unit}")) for name, unit in UNITS]
    tables = [
        *wide,
        ("The thesis's orderings", report.get("orderings", [])),
        ("Noise and wrong matches, 60 matches (AHAE)", report.get("noise", [])),
        ("Paths of the epipolar direction with that noise", report.get("epipolar_dcpe", [])),
        ("Priority functions, 60 matches (AHAE)", report.get("sweep", [])),
    ]
    figures = [
        (
            f"{name.upper()}, target in the {placement.replace('_', '-')}: {kind}",
            f"{name}-{placement}-{kind}.png",
        )
        for name, _ in UNITS
        for placement in PLACEMENTS
        for kind in ("boxes", "comparison")
    ]
    figures += [
        ("Growth of a pair's longitude difference and truth of its bisector", "pair-growth-and-heading.png"),
        ("Matches that vote backwards because their latitude shrinks", "latitude-decrease.png"),
        ("A path of method 2 that does not arrive", "failed-path-method-2.png"),
        ("A path of method 1 that does not arrive", "failed-path-method-1.png"),
    ]
    title = "Heading methods in random scenes"
    write_page(folder, "heading", title, "topnav study heading --plots FOLDER", tables, figures)


def _show(report: dict[str, Any]) -> None:
    for name, unit in UNITS:
        if name in report:
            print_rows(f"mean {name.upper()} ({unit})", _wide(report[name], f"mean_{unit}"))
    if "orderings" in report:
        shown = [{**row, "holds": "yes" if row["holds"] else "no"} for row in report["orderings"]]
        print_rows("the thesis's orderings", shown)
    if "noise" in report:
        chosen = [r for r in report["noise"] if r["noise_deg"] == 0.5 and r["outliers"] == 0.2]
        print_rows("AHAE with 0.5 deg noise and 20 % wrong matches, 60 matches", chosen)
        print_rows("paths of the epipolar direction, the same noise", report["epipolar_dcpe"])
    if "sweep" in report:
        print_rows("priority functions, 60 matches", report["sweep"])


def _wide(rows: list[dict[str, Any]], value: str) -> list[dict[str, object]]:
    """One row per placement and method, one column per number of matches."""
    table: dict[tuple[str, str], dict[str, object]] = {}
    for row in rows:
        key = (row["placement"], row["method"])
        line = table.setdefault(key, {"placement": key[0], "method": key[1]})
        line[str(row["keypoints"])] = row[value]
    return list(table.values())
