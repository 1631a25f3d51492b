"""Rates rise before they fall, and no step follows a slope steeper than allowed."""

from itertools import pairwise

import pytest
import torch

from experiments.training.learning.running import Schedule, run


def test_the_rate_rises_evenly_to_where_the_cosine_falls():
    plain, rising = Schedule(steps=1000, rate=0.5), Schedule(steps=1000, rate=0.5, warmup=4)
    shares = [rising.rate_at(step) / plain.rate_at(step) for step in range(7)]
    assert shares == pytest.approx([0.2, 0.4, 0.6, 0.8, 1.0, 1.0, 1.0])
    assert plain.rate_at(0) == pytest.approx(0.5)
    assert plain.rate_at(500) == pytest.approx(0.25)
    assert rising.rate_at(999) < 1e-5


@pytest.mark.parametrize(("clip", "expected"), [(None, 5000.0), (2.0, 2.0), (1e6, 5000.0)])
def test_gradients_together_are_no_longer_than_the_clip(tmp_path, clip, expected):
    network = torch.nn.ParameterList([torch.zeros(1), torch.zeros(1)])
    lengths = []

    def tick(_):
        lengths.append(float(torch.stack([value.grad for value in network]).norm()))

    schedule = Schedule(steps=2, clip=clip)
    loss_of = lambda net, _: 3000.0 * net[0].sum() + 4000.0 * net[1].sum()  # noqa: E731
    run(network, loss_of, schedule, schedule, tmp_path, tick)
    assert lengths == pytest.approx([expected] * 2)


def test_the_rate_of_each_step_is_the_schedules(tmp_path):
    """Adam moves a parameter of constant slope by the rate."""
    network = torch.nn.ParameterList([torch.zeros(1)])
    at, schedule = [0.0], Schedule(steps=5, rate=0.1, warmup=2)
    run(
        network,
        lambda net, _: net[0].sum(),
        schedule,
        schedule,
        tmp_path,
        lambda _: at.append(float(network[0].detach())),
    )
    moved = [before - after for before, after in pairwise(at)]
    assert moved == pytest.approx([schedule.rate_at(step) for step in range(5)], rel=1e-4)
