"""The figures of `topnav study photographs` as tables for people."""

from collections.abc import Mapping
from typing import Any

from services.launcher.terminal.output import print_figures, print_rows

PEER = "peer"


def show(figures: Mapping[str, Any]) -> None:
    """Print what was measured, one line per tour, the total last."""
    rows = [*figures["tours"], figures["total"]]
    print_rows("links of tours", rows)
    print_rows("a tilted camera", figures["tilt"])
    print_rows("confidence of answers", figures["calibration"]["bins"])
    print_figures(
        "all tours",
        {
            "pipeline": figures["pipeline"],
            "expected calibration error": figures["calibration"]["ece"],
            "pairs of different tours": figures["foreign_pairs"]["pairs"],
            "edges between them": figures["foreign_pairs"]["edges"],
            "ms per picture": figures["ms_per_picture"],
            "ms per pair": figures["ms_per_pair"],
        },
    )
