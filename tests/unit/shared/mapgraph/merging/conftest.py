"""Two streets that look the same, drawn with several seeds."""

import pytest

from tests.merge_world import Streets


@pytest.fixture(params=range(6))
def world(request: pytest.FixtureRequest) -> Streets:
    """Drawn anew."""
    return Streets(request.param)
