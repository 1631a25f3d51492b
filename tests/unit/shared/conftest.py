"""Two peers on one bus, of which the second sees the first."""

from collections.abc import Iterator

import pytest

from shared.bus import Bus, open_bus, wait_until

SOON_S = 30.0


@pytest.fixture
def here(router_endpoint: str) -> Iterator[Bus]:
    """One peer."""
    with open_bus(router_endpoint) as bus:
        yield bus


@pytest.fixture
def there(router_endpoint: str, here: Bus) -> Iterator[Bus]:
    """Another peer that sees the first."""
    here.announce("here")
    with open_bus(router_endpoint) as bus:
        assert wait_until(lambda: bus.alive("here") == ["here"], SOON_S)
        yield bus
