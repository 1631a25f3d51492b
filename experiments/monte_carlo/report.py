"""What `topnav study heading` measured: tables, figures and a page with all of them."""

from collections.abc import Collection
from pathlib import Path
from typing import Any

from experiments.monte_carlo import examples, study
from experiments.monte_carlo.boxes import draw_boxes, draw_comparison
from experiments.monte_carlo.claims import CLAIMS, Figures, judged
from experiments.monte_carlo.scene import PLACEMENTS, Placement
from experiments.work.page import write_page
from services.launcher.terminal.output import print_rows

UNITS = (("ahae", "deg"), ("dcpe", "pct"))
TITLE = "Heading methods in random scenes"
FAILED: tuple[tuple[str, Placement], ...] = (("2", "north"), ("1", "north_east"))
"""Methods whose paths do not arrive, and where the thesis shows it (figures 3.50, 3.67 and 3.68)."""

EXAMPLES = (
    ("Growth of a pair's longitude difference and truth of its bisector", "pair-growth-and-heading.png"),
    ("Matches that vote backwards because their latitude shrinks", "latitude-decrease.png"),
    *((f"A path of method {m} that does not arrive", f"failed-path-method-{m}.png") for m, _ in FAILED),
)


def measure(
    parts: Collection[str], size: study.Size, seed: int, work: study.Worker, gain: float, device: str
) -> tuple[dict[str, Any], dict[str, Figures]]:
    """The report as --json writes it, and the statistics behind it that are drawn."""
    report: dict[str, Any] = {"seed": seed, "scenes": size.scenes, "ahae_runs": size.ahae_runs, "gain": gain}
    measured: dict[str, Figures] = {}
    if "ahae" in parts:
        measured["ahae"] = study.ahae(size, seed, work, gain)
    if "dcpe" in parts:
        measured["dcpe"] = study.dcpe(size, seed, work, gain, device)
        report |= {"dcpe_scenes": size.dcpe_scenes, "dcpe_runs": size.dcpe_runs}
    for name, unit in UNITS:
        if name in measured:
            report[name] = [row for p, s in measured[name].items() for row in s.rows(p, unit)]
    if measured:
        report["orderings"] = judged(CLAIMS, measured)
    if "noise" in parts:
        report["noise"], report["epipolar_dcpe"] = study.noise(size, seed, work)
    if "sweep" in parts:
        report["sweep"] = study.sweep(size, seed, work)
    return report, measured


def draw(folder: Path, report: dict[str, Any], measured: dict[str, Figures], *, with_examples: bool) -> None:
    """All figures, and a page of tables and figures."""
    figures = []
    for (name, _), placement in ((unit, p) for unit in UNITS for p in PLACEMENTS):
        title = f"{name.upper()}, target in the {placement.replace('_', '-')}"
        for kind, drawing in (("boxes", draw_boxes), ("comparison", draw_comparison)):
            file = f"{name}-{placement}-{kind}.png"
            figures.append((f"{title}: {kind}", file))
            if name in measured:
                drawing(folder / file, title, {"ahae": "deg", "dcpe": "%"}[name], measured[name][placement])
    if with_examples:
        _draw_examples(folder)
    wide = [(f"Mean {name.upper()}", _wide(report.get(name, []), f"mean_{unit}")) for name, unit in UNITS]
    tables = [
        *wide,
        ("The thesis's orderings", report.get("orderings", [])),
        ("Noise and wrong matches, 60 matches (AHAE)", report.get("noise", [])),
        ("Paths of the epipolar direction with that noise", report.get("epipolar_dcpe", [])),
        ("Priority functions, 60 matches (AHAE)", report.get("sweep", [])),
    ]
    write_page(folder, "heading", TITLE, "topnav study heading --plots FOLDER", tables, [*figures, *EXAMPLES])


def show(report: dict[str, Any]) -> None:
    """Print what people look for first."""
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


def _draw_examples(folder: Path) -> None:
    (_, cloud), (_, latitude), *_ = EXAMPLES
    examples.draw_pair_cloud(folder / cloud, "centre", 1)
    examples.draw_latitude_case(folder / latitude, "centre", 4)
    for method, placement in FAILED:
        examples.draw_failed_path(folder / f"failed-path-method-{method}.png", method, placement, 1)


def _wide(rows: list[dict[str, Any]], value: str) -> list[dict[str, object]]:
    """One row per placement and method, one column per number of matches."""
    table: dict[tuple[str, str], dict[str, object]] = {}
    for row in rows:
        key = (row["placement"], row["method"])
        line = table.setdefault(key, {"placement": key[0], "method": key[1]})
        line[str(row["keypoints"])] = row[value]
    return list(table.values())
