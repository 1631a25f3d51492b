"""Matching by attention over the keypoints of two panoramas, as in LightGlue (Lindenberger et al. 2023).

Keypoints of one picture see where the others are by a rotary encoding of their bearings: longitudes in whole
numbers of turns, so that turning a camera changes nothing, and latitudes. Plain torch modules.
"""

from dataclasses import dataclass

import numpy as np
import torch
from torch import nn
from torch.nn import functional

from services.features.pipeline.interfaces import FeatureSet, Float32Array

CONTEXT = 4
"""Numbers of a keypoint."""
SIZE_RAD, SCORE = 0.05, 0.1
"""Typical size and strength of SIFT's keypoints, so that their logarithms are about 0."""
SHARPNESS = 15.0
"""Factor of the descriptors' cosines with which training begins: that of `topnav train keypoints`."""
LISTENING = 8.0
"""The same factor where a keypoint chooses whom of the other picture it hears: less, as it hears many."""
SILENCE = 1e-30
"""Least sum of what a keypoint hears, so that one which only fills up hears nothing."""
ANSWERS = 3
"""Of a pair: logit of the same place, logit of the overlap, logarithm of the metres between them."""


@dataclass(frozen=True, eq=False)
class Keypoints:
    """A batch of pictures with N keypoints each.

    Attributes:
        lonlat_rad: (B, N, 2).
        descriptors: (B, N, D) unit vectors.
        context: (B, N, CONTEXT).
        present: (B, N) False for those that only fill up; None where there are none.
    """

    lonlat_rad: torch.Tensor
    descriptors: torch.Tensor
    context: torch.Tensor
    present: torch.Tensor | None = None


@dataclass(frozen=True, eq=False)
class Assignment:
    """What a layer says of a batch of pairs.

    Attributes:
        log_right: (B, N, M) logarithm of the probability that both are the same point.
        matchable: two of (B, N) and (B, M), logits: the point is found in the other picture.
        pair: (B, ANSWERS).
    """

    log_right: torch.Tensor
    matchable: tuple[torch.Tensor, torch.Tensor]
    pair: torch.Tensor


def context_of(features: FeatureSet) -> Float32Array:
    """(N, 4): sine of the latitude and its square, and logarithms of size and strength."""
    sizes = np.full(len(features), SIZE_RAD) if features.sizes_rad is None else features.sizes_rad
    height = np.sin(features.lonlat_rad[:, 1])
    columns = (
        height,
        height**2,
        np.log(np.maximum(sizes, 1e-4) / SIZE_RAD),
        np.log(np.maximum(features.scores, 1e-6) / SCORE),
    )
    return np.stack(columns, axis=-1).astype(np.float32)


class Attention(nn.Module):  # type: ignore[misc] # torch is not followed, see pyproject.toml
    """Layers of attention within each picture and between both."""

    def __init__(self, dimension: int, width: int = 64, heads: int = 2, layers: int = 3) -> None:
        super().__init__()
        self.width, self.heads = width, heads
        self.enter = nn.Linear(dimension + CONTEXT, width)
        self.layers = nn.ModuleList(Layer(width, heads) for _ in range(layers))
        self.heads_out = nn.ModuleList(Answer(width) for _ in range(layers))
        turns = torch.round(1.7 ** torch.arange(width // heads // 4).float())
        self.register_buffer("turns", turns, persistent=False)

    def forward(self, one: Keypoints, other: Keypoints) -> list[Assignment]:
        """The answers of all layers, the last one last."""
        first, second = self.entered(one), self.entered(other)
        turned, turned_other = self.rotary(one.lonlat_rad), self.rotary(other.lonlat_rad)
        cosines = one.descriptors @ other.descriptors.transpose(1, 2)
        answers = []
        for layer, answer in zip(self.layers, self.heads_out, strict=True):
            first, second = layer(first, second, turned, turned_other, cosines, one.present, other.present)
            answers.append(answer(first, second, cosines, one.present, other.present))
        return answers

    def last(self, one: Keypoints, others: Keypoints, hopeless: float) -> tuple[list[int], Assignment | None]:
        """The last layer's answer for one picture and B others.

        Args:
            one: keypoints of one picture.
            others: those of the others.
            hopeless: probability of the same place below which layers stop.

        Returns:
            Numbers of the others that no layer before found another place, and what the last one says of
            them; None where there are none.
        """
        first, second = self.entered(one), self.entered(others)
        turned, turned_other = self.rotary(one.lonlat_rad), self.rotary(others.lonlat_rad)
        cosines, present = one.descriptors @ others.descriptors.transpose(1, 2), others.present
        numbers = torch.arange(len(second), device=second.device)
        for number, layer in enumerate(self.layers):
            first, second = layer(first, second, turned, turned_other, cosines, one.present, present)
            if number % 2 and number + 1 < len(self.layers):
                pair = self.heads_out[number].of_pair(first, second, one.present, present)
                hopeful = torch.sigmoid(pair[:, 0]) >= hopeless
                if not bool(hopeful.any()):
                    return [], None
                if bool(hopeful.all()):
                    continue
                first, second, cosines, numbers = (x[hopeful] for x in (first, second, cosines, numbers))
                turned_other = turned_other[hopeful]
                present = None if present is None else present[hopeful]
        answer: Assignment = self.heads_out[-1](first, second, cosines, one.present, present)
        return numbers.tolist(), answer

    def entered(self, points: Keypoints) -> torch.Tensor:
        """(B, N, width) what the first layer gets."""
        scaled = points.descriptors * points.descriptors.shape[-1] ** 0.5
        return self.enter(torch.cat([scaled, points.context], dim=-1))

    def rotary(self, lonlat_rad: torch.Tensor) -> torch.Tensor:
        """(B, 1, N, width / heads / 2) complex numbers by which queries and keys are turned."""
        angle = (lonlat_rad[..., None] * self.turns).flatten(-2)
        return torch.complex(torch.cos(angle), torch.sin(angle))[:, None]


class Layer(nn.Module):  # type: ignore[misc]
    """Attention within each picture, then from each to the other."""

    def __init__(self, width: int, heads: int) -> None:
        super().__init__()
        self.heads = heads
        self.within, self.within_out = nn.Linear(width, 3 * width), nn.Linear(width, width)
        self.within_mix = _mix(width)
        self.across, self.across_out = nn.Linear(width, 2 * width), nn.Linear(width, width)
        self.across_mix = _mix(width)
        self.listening = nn.Parameter(torch.full((heads, 1, 1), LISTENING))

    def forward(
        self,
        one: torch.Tensor,
        other: torch.Tensor,
        turned: torch.Tensor,
        turned_other: torch.Tensor,
        cosines: torch.Tensor,
        present: torch.Tensor | None,
        present_other: torch.Tensor | None,
    ) -> tuple[torch.Tensor, torch.Tensor]:
        """Both pictures' keypoints, (B, N, width) and (B, M, width), knowing more.

        Across, a keypoint hears most of those whose descriptors (cosines, (B, N, M)) are like its own.
        """
        one, other = self._inside(one, turned, present), self._inside(other, turned_other, present_other)
        one = one.expand(len(other), -1, -1)  # what it sees within itself is the same for all others
        key, value = self._split(self.across(one), 2)
        key_other, value_other = self._split(self.across(other), 2)
        heard = self.heard(key, key_other, cosines, present, present_other)
        from_other, from_one = gathered(heard, value_other), gathered(heard.transpose(2, 3), value)
        return (
            one + self.across_mix(torch.cat([one, self.across_out(from_other)], dim=-1)),
            other + self.across_mix(torch.cat([other, self.across_out(from_one)], dim=-1)),
        )

    def _inside(
        self, points: torch.Tensor, turned: torch.Tensor, present: torch.Tensor | None
    ) -> torch.Tensor:
        query, key, value = self._split(self.within(points), 3)
        mask = None if present is None else present[:, None, None, :]
        seen = functional.scaled_dot_product_attention(
            _turn(query, turned), _turn(key, turned), value, attn_mask=mask
        )
        return points + self.within_mix(torch.cat([points, self.within_out(_joined(seen))], dim=-1))

    def _split(self, joined: torch.Tensor, parts: int) -> tuple[torch.Tensor, ...]:
        batch, count, _ = joined.shape
        apart = joined.reshape(batch, count, parts, self.heads, -1).permute(2, 0, 3, 1, 4)
        return tuple(apart[part] for part in range(parts))

    def heard(
        self,
        key: torch.Tensor,
        key_other: torch.Tensor,
        cosines: torch.Tensor,
        present: torch.Tensor | None,
        present_other: torch.Tensor | None,
    ) -> torch.Tensor:
        """(B, heads, N, M) how much a keypoint hears of each other, and that of it, up to a factor."""
        alike = ((key * key.shape[-1] ** -0.5) @ key_other.transpose(2, 3)).float()
        alike = alike.addcmul_(self.listening, cosines[:, None].float())  # in place: it is large
        heard = alike.sub_(alike.detach().amax((2, 3), keepdim=True)).exp_()
        if present is not None:
            heard = heard.masked_fill(~present[:, None, :, None], 0.0)
        if present_other is not None:
            heard = heard.masked_fill(~present_other[:, None, None, :], 0.0)
        return heard


class Answer(nn.Module):  # type: ignore[misc]
    """What the keypoints say after a layer."""

    def __init__(self, width: int) -> None:
        super().__init__()
        self.project, self.matchable = nn.Linear(width, width), nn.Linear(width, 1)
        self.sharpness = nn.Parameter(torch.tensor(SHARPNESS))
        self.pair = nn.Sequential(nn.Linear(2 * width, width), nn.GELU(), nn.Linear(width, ANSWERS))

    def forward(
        self,
        one: torch.Tensor,
        other: torch.Tensor,
        cosines: torch.Tensor,
        present: torch.Tensor | None,
        present_other: torch.Tensor | None,
    ) -> Assignment:
        """Double softmax of similarities, times that both are matchable at all.

        What the layers found is added to what the descriptors say by themselves: they need not learn anew
        through a narrow width what 128 numbers told already.
        """
        likeness = self.project(one) @ self.project(other).transpose(1, 2) / one.shape[-1] ** 0.5
        likeness = likeness.float() + self.sharpness * cosines.float()
        if present is not None:
            likeness = likeness.masked_fill(~present[:, :, None], -1e4)
        if present_other is not None:
            likeness = likeness.masked_fill(~present_other[:, None, :], -1e4)
        first, second = self.matchable(one)[..., 0].float(), self.matchable(other)[..., 0].float()
        rows = functional.logsigmoid(first)[:, :, None] - likeness.logsumexp(2, keepdim=True)
        columns = functional.logsigmoid(second)[:, None, :] - likeness.logsumexp(1, keepdim=True)
        log_right = (2.0 * likeness).add_(rows).add_(columns)  # in place: it is large
        return Assignment(log_right, (first, second), self.of_pair(one, other, present, present_other))

    def of_pair(
        self,
        one: torch.Tensor,
        other: torch.Tensor,
        present: torch.Tensor | None,
        present_other: torch.Tensor | None,
    ) -> torch.Tensor:
        """(B, ANSWERS), the same whichever picture comes first."""
        both = _mean(one, present), _mean(other, present_other)
        joined = torch.cat([both[0] + both[1], (both[0] - both[1]).abs()], dim=-1)
        found: torch.Tensor = self.pair(joined).float()
        return found


def gathered(heard: torch.Tensor, values: torch.Tensor) -> torch.Tensor:
    """(B, N, width) means of (B, heads, M, -1) values by what is heard of each; 0 where nothing is."""
    total = heard.sum(3, keepdim=True).clamp(min=SILENCE)
    return _joined((heard.to(values.dtype) @ values) / total.to(values.dtype))


def _joined(heads: torch.Tensor) -> torch.Tensor:
    return heads.transpose(1, 2).flatten(2)


def _mean(points: torch.Tensor, present: torch.Tensor | None) -> torch.Tensor:
    if present is None:
        return points.mean(1)
    weight = present[..., None].to(points.dtype)
    return (points * weight).sum(1) / weight.sum(1).clamp(min=1.0)


def _mix(width: int) -> nn.Module:
    return nn.Sequential(
        nn.Linear(2 * width, 2 * width), nn.LayerNorm(2 * width), nn.GELU(), nn.Linear(2 * width, width)
    )


def _turn(vectors: torch.Tensor, turned: torch.Tensor) -> torch.Tensor:
    """Every two numbers of a vector are one complex number."""
    numbers = torch.view_as_complex(vectors.float().unflatten(-1, (-1, 2)))
    return torch.view_as_real(numbers * turned).flatten(-2).to(vectors.dtype)
