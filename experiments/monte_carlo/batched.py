"""Methods 1 to 6 for a whole batch of runs at once, on any torch device. Radians, float64.

The same formulas as services/planner/heading, which a test compares; here without a Python loop, because the
study asks for hundreds of millions of headings.
"""

from collections.abc import Callable

import torch
from torch import Tensor

TOLERANCE = 1e-12  # of sgn: what float64 leaves of a difference that is zero


Vote = tuple[Tensor, Tensor]
"""(B, 2) vector and (B,) logarithm of its scale."""


def batch_headings(method: str, current: Tensor, target: Tensor, gain_per_rad: float) -> Tensor:
    """Headings (B,) from longitudes and latitudes (B, N, 2); weights are exp(gain_per_rad * angle)."""
    vector, _ = _methods()[method](current, target, gain_per_rad)
    return torch.atan2(vector[:, 1], vector[:, 0])


def all_headings(current: Tensor, target: Tensor, gain_per_rad: float) -> Tensor:
    """Headings (6, B) of methods 1 to 6, which share their votes."""
    pairs = _Pairs(current, target)
    one, two = pairs.plain(), pairs.weighted(gain_per_rad)
    three, four = _singles(current, target, None), _singles(current, target, gain_per_rad)
    votes = (one, two, three, four, _sum(one, four), _sum(two, four))
    return torch.stack([torch.atan2(vector[:, 1], vector[:, 0]) for vector, _ in votes])


def _methods() -> dict[str, Callable[[Tensor, Tensor, float], Vote]]:
    return {
        "1": lambda c, t, _: _Pairs(c, t).plain(),
        "2": lambda c, t, g: _Pairs(c, t).weighted(g),
        "3": lambda c, t, _: _singles(c, t, None),
        "4": lambda c, t, g: _singles(c, t, g),
        "5": lambda c, t, g: _sum(_Pairs(c, t).plain(), _singles(c, t, g)),
        "6": lambda c, t, g: _sum(_Pairs(c, t).weighted(g), _singles(c, t, g)),
    }


class _Pairs:
    """Equations (2.1) to (2.10). Every pair is met twice, as (i, j) and (j, i), which changes no direction.

    Without trigonometry but for the weights: a sum of unit vectors has length sqrt(2 + 2 dot), and the
    bisectors of keypoint i add up to u_i times the sum of its row.
    """

    def __init__(self, current: Tensor, target: Tensor) -> None:
        self._u, v = _units(current), _units(target)
        self._dot_c, self._dot_t = self._u @ self._u.mT, v @ v.mT
        kept = (_sign(_crosses(self._u) * _crosses(v)) + 1.0) / 2.0
        vote = 1.0 + kept * (_sign(self._dot_c - self._dot_t) - 1.0)
        self._vote = vote * (2.0 + 2.0 * self._dot_c).clamp_min(TOLERANCE).rsqrt()
        self._vote.diagonal(dim1=1, dim2=2).zero_()

    def plain(self) -> Vote:
        """Method 1."""
        return (self._vote @ self._u).sum(1), torch.zeros_like(self._u[:, 0, 0])

    def weighted(self, gain: float) -> Vote:
        """Method 2."""
        logs = gain * (torch.acos(self._dot_t.clamp(-1.0, 1.0)) - torch.acos(self._dot_c.clamp(-1.0, 1.0)))
        scale = logs.amax((1, 2))
        vote = self._vote * torch.exp(logs - scale[:, None, None])
        return (vote @ self._u).sum(1), scale


def _singles(current: Tensor, target: Tensor, gain: float | None) -> Vote:
    """Equations (2.11) to (2.18) over all matches."""
    u = _units(current)
    lat_c, lat_t = current[..., 1], target[..., 1]
    a = _sign(torch.cos(lat_c) - torch.cos(lat_t))
    b = (_sign(torch.sin(lat_c) * torch.sin(lat_t)) + 1.0) / 2.0
    growth = None if gain is None else gain * (lat_t.abs() - lat_c.abs())
    return _weighted((1.0 + b * (a - 1.0))[..., None] * u, growth)


def _weighted(votes: Tensor, log_weights: Tensor | None) -> Vote:
    if log_weights is None:
        return votes.sum(1), torch.zeros_like(votes[:, 0, 0])
    scale = log_weights.amax(1)
    return (votes * torch.exp(log_weights - scale[:, None])[..., None]).sum(1), scale


def _sum(a: Vote, b: Vote) -> Vote:
    scale = torch.maximum(a[1], b[1])
    return a[0] * torch.exp(a[1] - scale)[:, None] + b[0] * torch.exp(b[1] - scale)[:, None], scale


def _units(lonlat: Tensor) -> Tensor:
    """Longitude unit vectors (B, N, 2)."""
    return torch.stack([torch.cos(lonlat[..., 0]), torch.sin(lonlat[..., 0])], -1)


def _crosses(u: Tensor) -> Tensor:
    """Cross products of all pairs (B, N, N)."""
    turned = torch.stack([u[..., 1], -u[..., 0]], -1)
    return turned @ u.mT


def _sign(values: Tensor) -> Tensor:
    return torch.where(values.abs() <= TOLERANCE, 0.0, torch.sign(values))
