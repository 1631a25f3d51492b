"""What the two-view estimation gains or loses with half and twice each of its figures; gates nothing.

pytest -q -s tests/benchmarks/test_two_view_effort.py

Synthetic rooms, 16 to 160 matches of which 30 to 85 % are wrong, over 0.1 to 4 m; for cameras that lean the
camera is tilted by 5 degrees. `right` is answered within 3 degrees, `wrong` answered otherwise.
"""

import dataclasses
import time

import numpy as np
import pytest

from shared.geometry import planar, planar_fit, rotation
from shared.geometry.tilted import search
from shared.geometry.two_view import TwoViewSettings, two_view
from tests.unit.shared.geometry.synthetic_room import error_deg, make_scene

pytestmark = [pytest.mark.slow, pytest.mark.timeout(1200)]

DISTANCES_M = (0.1, 0.2, 0.5, 1.0, 2.0, 4.0)
PLANAR = TwoViewSettings(tilting=False)
TILTED = TwoViewSettings()
FIGURES = {
    planar_fit: ("SIGNED", "REFINED", "PARALLAX_REACH", "PARALLAX_FLOOR_RAD", "REACH"),
    planar: ("CHANCE_SHIFTS",),
    PLANAR: ("pairs", "threshold_rad", "min_inliers", "no_baseline_rad", "no_baseline_noise",
             "min_parallax_z", "max_log_nfa", "max_heading_std_rad"),
    search: ("PAIRS", "LINES", "STARTS", "LEFT", "RIVALS", "HOPELESS", "WIDE_RAD", "FIVES", "SURE_COUNT"),
    rotation: ("PAIRS",),
    TILTED: ("tilting_min_right", "settled_noise", "settled_near", "settled_share", "min_nats",
             "min_parallax_nats"),
}  # fmt: skip


def scenes(tilt_deg, count):
    """Scenes that moved, that only turned, and that have nothing in common; a few to many matches each."""
    rng = np.random.default_rng(21)
    found = {"moved": [], "turned": [], "unrelated": []}
    for kind, rooms in found.items():
        for k in range(count):
            matches = int(rng.integers(16, 160))
            wrong = matches if kind == "unrelated" else int(matches * rng.uniform(0.3, 0.85))
            distance_m = DISTANCES_M[k % len(DISTANCES_M)] if kind == "moved" else 0.0
            rooms.append(make_scene(rng, matches, wrong, distance_m, tilt_deg=tilt_deg))
    return found


def measured(limits, rooms):
    """What the estimation says of all scenes, and its processor time."""
    began_s = time.process_time()
    results = {
        kind: [two_view(s.current, s.target, np.random.default_rng(k), limits) for k, s in enumerate(some)]
        for kind, some in rooms.items()
    }
    ms = (time.process_time() - began_s) / sum(map(len, rooms.values())) * 1e3
    moved = zip(results["moved"], rooms["moved"], strict=True)
    errors = np.array([error_deg(r.heading_rad, s.heading_rad) for r, s in moved if r.usable])
    return {
        "right": (errors < 3.0).sum() / len(rooms["moved"]),
        "wrong": (errors >= 3.0).sum() / len(rooms["moved"]),
        "median_deg": np.median(errors),
        "turned_told": np.mean([r.status == "no_baseline" for r in results["turned"]]),
        "turned_answered": np.mean([r.usable for r in results["turned"]]),
        "unrelated_answered": np.mean([r.usable for r in results["unrelated"]]),
        "ms": ms,
    }


@pytest.mark.parametrize(
    ("where", "name"),
    [pytest.param(where, name, id=name) for where, names in FIGURES.items() for name in names],
)
def test_half_and_twice(where, name, monkeypatch, keep):
    tilted = where in (search, rotation, TILTED)
    rooms = scenes(5.0, 60) if tilted else scenes(0.0, 200)
    usual, found = getattr(where, name), {}
    for factor in (0.5, 1.0, 2.0):
        value, limits = type(usual)(usual * factor), TILTED if tilted else PLANAR
        if isinstance(where, TwoViewSettings):
            limits = dataclasses.replace(limits, **{name: value})
        else:
            monkeypatch.setattr(where, name, value)
        found[f"{value:.4g}"] = measured(limits, rooms)
    keep(found)
