"""What a loaded gateway does to the time from a heading to its command. Never gates on how fast it was."""

import pytest

from tests.faults.gateway_load import PER_CLIENT, READERS, loaded, measure

pytestmark = [pytest.mark.slow, pytest.mark.timeout(300)]

PHASE_S = 15.0


def test_figures_of_a_loaded_gateway(repository, tmp_path, router_endpoint, free_port, keep):
    limits = {"max_sockets": READERS + 50, "max_sockets_per_client": PER_CLIENT}
    with loaded(repository, tmp_path, router_endpoint, free_port, **limits) as running:
        figures = measure(running, PHASE_S)
    keep(figures)
    assert all(value > 0.0 for value in figures.values())
