"""Connected components of small graphs."""

import pytest

from services.launcher.evaluation.components import components


@pytest.mark.parametrize(
    ("nodes", "edges", "count"),
    [
        pytest.param([], [], 0, id="nothing"),
        pytest.param([3, 7], [], 2, id="two alone"),
        pytest.param([0, 1, 2, 3], [(0, 1), (2, 3)], 2, id="two pairs"),
        pytest.param([0, 1, 2, 3], [(2, 3), (0, 1), (1, 2), (0, 3)], 1, id="a ring"),
    ],
)
def test_components_are_counted(nodes, edges, count):
    assert components(nodes, edges) == count
