"""SPL of Anderson et al.: hand-computed values."""

import pytest

from services.launcher.evaluation.spl import spl


@pytest.mark.parametrize(
    ("success", "shortest_m", "driven_m", "expected"),
    [(True, 2.0, 4.0, 0.5), (True, 2.0, 2.0, 1.0), (True, 2.0, 1.8, 1.0), (False, 2.0, 2.0, 0.0)],
)
def test_spl_of_one_round(success, shortest_m, driven_m, expected):
    assert spl(success, shortest_m, driven_m) == expected


def test_a_shortest_way_of_no_length_is_an_error():
    with pytest.raises(ValueError, match="shortest_m must be positive, got 0"):
        spl(True, 0.0, 1.0)
