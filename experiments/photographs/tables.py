"""Figures of answers: shares, errors, calibration. Pure."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from experiments.photographs.comparing import Answer
from experiments.work.reliability import RIGHT_DEG, reliability
from services.launcher.terminal.output import rounded

OPPOSITE_DEG = 90.0
"""Off by more, a robot drives away."""

Row = dict[str, Any]


@dataclass(frozen=True)
class LinkAnswer:
    """The answer to a link whose bearing is known, degrees."""

    bearing_deg: float
    answer: Answer

    @property
    def off_deg(self) -> float | None:
        """Angle between answered heading and known bearing, 0 to 180; None without an answer."""
        heading_deg = self.answer.heading_deg
        return None if heading_deg is None else apart_deg(heading_deg, self.bearing_deg)


def apart_deg(a_deg: float, b_deg: float) -> float:
    """Angle between two directions, 0 to 180 degrees."""
    return abs((a_deg - b_deg + 180.0) % 360.0 - 180.0)


def heading_figures(offs_deg: Sequence[float | None]) -> Row:
    """Shares and errors of links by how far their answers are off; None is no answer."""
    errors = np.array([off for off in offs_deg if off is not None])
    return {
        "links": len(offs_deg),
        "answered": share([off is not None for off in offs_deg]),
        "within_20": share(list(errors < RIGHT_DEG)),
        "beyond_90": share(list(errors > OPPOSITE_DEG)),
        "median_deg": rounded(np.median(errors), 2) if len(errors) else None,
        "p90_deg": rounded(np.percentile(errors, 90), 2) if len(errors) else None,
    }


def row(
    name: str, pictures: int, links: Sequence[LinkAnswer], wrong_edges: int, recalled: Sequence[bool]
) -> Row:
    """One line of the table.

    Args:
        name: of the tour.
        pictures: how many.
        links: with their answers.
        wrong_edges: pairs of different places that would be connected.
        recalled: of each picture with a link, whether the most similar one is a neighbour.
    """
    return {
        "name": name,
        "pictures": pictures,
        **heading_figures([link.off_deg for link in links]),
        "edges": share([link.answer.edge for link in links]),
        "wrong_edges": wrong_edges,
        "recall_at_1": share(recalled),
    }


def tilt_row(deg: float, same: Sequence[Answer], changes_deg: Sequence[float]) -> Row:
    """One tilt: pictures against themselves, and by how much the headings of links change."""
    moved = [answer.status == "ok" for answer in same]
    return {
        "deg": deg,
        "same_moved": share(moved),
        "same_edges": share([is_ok and answer.edge for is_ok, answer in zip(moved, same, strict=True)]),
        "median_change_deg": rounded(np.median(changes_deg), 2) if len(changes_deg) else None,
    }


def calibration(links: Sequence[LinkAnswer]) -> Row:
    """How often answers of a confidence are right, and the expected calibration error (ece)."""
    return reliability([(link.answer.confidence, link.off_deg) for link in links if link.off_deg is not None])


def share(these: Sequence[bool]) -> float | None:
    """How many of these are so, 0 to 1; None of nothing."""
    return rounded(np.mean(these)) if len(these) else None
