"""Networks that describe 32 x 32 patches, with the names of parameters that kornia's modules have.

What is trained in these shapes is loaded by `kornia.feature.HardNet` and `SOSNet`, too; a machine that trains
needs no kornia.
"""

from typing import Literal

import torch

Shape = Literal["hardnet", "sosnet", "slim"]
WIDTH = 128
"""Numbers of a descriptor (Mishchuk et al. 2017)."""
SLIM = 4
"""Part of HardNet's channels that the slim one has: its convolutions take a twelfth of the time."""
FLAT = 1e-6
"""Added to the deviation of a patch's pixels, as in kornia: a flat one is divided by it."""
FIRST_GAIN = 0.6
"""Of the orthogonal matrices that a network begins with (HardNet's code)."""


class HardNet(torch.nn.Module):  # type: ignore[misc] # torch is not followed, see pyproject.toml
    """(N, 1, 32, 32) grey patches of any brightness and contrast to (N, 128) unit vectors.

    Mishchuk et al. 2017; `part` is that of the published number of channels, as 1 / part.
    """

    def __init__(self, part: int = 1) -> None:
        super().__init__()
        self.features = torch.nn.Sequential(*_layers(part, dropout=0.3))
        _begin(self)

    def forward(self, patches: torch.Tensor) -> torch.Tensor:
        """Unit vectors, float32 whatever the convolutions were computed in."""
        deviation, mean = torch.std_mean(patches, dim=(-3, -2, -1), keepdim=True)
        return _unit(self.features(_layout((patches - mean) / (deviation + FLAT))))


class SosNet(torch.nn.Module):  # type: ignore[misc]
    """As `HardNet` (Tian et al. 2019), which differs in how patches and dropout are scaled."""

    def __init__(self) -> None:
        super().__init__()
        self.layers = torch.nn.Sequential(torch.nn.InstanceNorm2d(1, affine=False), *_layers(1, dropout=0.1))
        _begin(self)

    def forward(self, patches: torch.Tensor) -> torch.Tensor:
        """Unit vectors, float32 whatever the convolutions were computed in."""
        return _unit(self.layers(_layout(patches)))


def network_named(shape: Shape) -> torch.nn.Module:
    """A network as it begins, drawn from torch's generator."""
    if shape == "sosnet":
        return SosNet()
    return HardNet(SLIM if shape == "slim" else 1)


def _layers(part: int, dropout: float) -> list[torch.nn.Module]:
    """Six convolutions of 3 x 3, two of which halve the side, and one of 8 x 8 that sees all that is left."""
    layers: list[torch.nn.Module] = []
    channels = 1
    for wide, stride in ((32, 1), (32, 1), (64, 2), (64, 1), (128, 2), (128, 1)):
        layers += [
            torch.nn.Conv2d(channels, wide // part, 3, stride=stride, padding=1, bias=False),
            torch.nn.BatchNorm2d(wide // part, affine=False),
            torch.nn.ReLU(),
        ]
        channels = wide // part
    return [
        *layers,
        torch.nn.Dropout(dropout),
        torch.nn.Conv2d(channels, WIDTH, 8, bias=False),
        torch.nn.BatchNorm2d(WIDTH, affine=False),
    ]


def _layout(patches: torch.Tensor) -> torch.Tensor:
    """Channels beside one another in memory: convolutions take two thirds of the time."""
    return patches.to(memory_format=torch.channels_last)


def _unit(found: torch.Tensor) -> torch.Tensor:
    return torch.nn.functional.normalize(found.flatten(1).float(), dim=1)


def _begin(network: torch.nn.Module) -> None:
    for layer in network.modules():
        if isinstance(layer, torch.nn.Conv2d):
            torch.nn.init.orthogonal_(layer.weight, gain=FIRST_GAIN)
