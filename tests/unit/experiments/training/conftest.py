"""What all tests of training may read."""

import pytest

from tests.unit.experiments.training.places import Places, written_places


@pytest.fixture(scope="session")
def places(tmp_path_factory: pytest.TempPathFactory) -> Places:
    """Written once; nobody may change them."""
    return written_places(tmp_path_factory.mktemp("places"))
