"""What a peer makes of the rendered tour; skipped where it is not installed."""

import pytest

from experiments.photographs.peer import load_pycolmap, measure_peer
from experiments.photographs.tables import heading_figures
from experiments.photographs.tours import read_tours

pytest.importorskip("pycolmap")


@pytest.mark.render
@pytest.mark.slow
def test_bearings_of_a_reconstruction_are_those_of_our_pictures(example):
    told: list[str] = []
    found = measure_peer(load_pycolmap(), read_tours(example), 1, told.append)
    (tour,) = found["tours"]
    assert tour.keys() == {"name", "pictures", "seconds", *heading_figures([])}
    assert tour["answered"] > 0.0  # how many varies with the order in which its threads add up
    assert tour["p90_deg"] < 1.0
    assert found["total"]["links"] == tour["links"]
    assert told
