"""What a detector and its descriptors learn from a pair of panoramas whose geometry is known.

- Descriptors: of keypoints, and of points drawn at random, that are the same point, the logarithm of the dual
  softmax (as LoFTR, Sun et al. 2021, and XFeat have it).
- Scores: a keypoint is drawn from the softmax of the scores in each cell, as in DISK (Tyszkiewicz et al.
  2020); its score learns how likely it is found and matched right in the other picture, and what was drawn is
  rewarded by it.
"""

from dataclasses import dataclass

import torch
from torch.nn import functional

from experiments.training.panoramas.store import Panoramas, bearings, lonlat
from experiments.training.panoramas.strips import continued, grid_of, lonlat_of_strip
from services.features.networks.spherical_keypoints import KeypointNet, Maps, described
from services.features.representations.equirectangular import PAD_COLUMNS

CELL_PX = 8
RIGHT_RAD = 0.0123
"""A keypoint this near to the true place is the same point: 0.7 degrees, as verification allows."""


@dataclass(frozen=True, eq=False)
class Drawn:
    """Keypoints drawn in a batch of pictures.

    Attributes:
        pixels: (B, K, 2) of the strip without its continuation, continuous.
        scores: (B, K) logits at them.
        log_chosen: (B, K) logarithm of the probability with which each was drawn in its cell.
    """

    pixels: torch.Tensor
    scores: torch.Tensor
    log_chosen: torch.Tensor


def pair_losses(
    network: KeypointNet,
    grays: torch.Tensor,
    shifts: torch.Tensor,
    pairs: torch.Tensor,
    panoramas: Panoramas,
    temperature: torch.Tensor,
    points: int,
    keypoints: int,
    generator: torch.Generator,
) -> dict[str, torch.Tensor]:
    """Mean losses of P pairs.

    Args:
        network: whose scores and maps are judged.
        grays: (2P, 1, 288, 800) strips, those here before those there, turned by whole columns.
        shifts: (2P,) columns by which each was turned to the right.
        pairs: (P, 2) numbers of the panoramas.
        panoramas: what is known of them.
        temperature: factor of similarities.
        points: random points of each pair.
        keypoints: of each picture.
        generator: draws points and keypoints.
    """
    scores, maps = network(continued(grays))
    scores = scores[:, :, PAD_COLUMNS:-PAD_COLUMNS].float()
    maps = tuple(map_.float() for map_ in maps)
    with torch.autocast(grays.device.type, enabled=False):  # to bfloat16, 3 degrees are no angle at all
        looking = _Looking(network, maps, shifts, panoramas, pairs)
        return _losses(looking, scores, temperature, points, keypoints, generator)


def _losses(
    looking: "_Looking",
    scores: torch.Tensor,
    temperature: torch.Tensor,
    points: int,
    keypoints: int,
    generator: torch.Generator,
) -> dict[str, torch.Tensor]:
    count = len(scores) // 2
    drawn = draw_keypoints(scores, keypoints, generator)
    vectors = looking.descriptors(drawn.pixels)
    expected, visible, _ = looking.expected(drawn.pixels[:count])
    cosine = expected @ looking.bearings(drawn.pixels, slice(count, None)).transpose(1, 2)
    right = (cosine >= torch.cos(torch.tensor(RIGHT_RAD))) & visible[..., None]
    log_same = _dual_softmax(vectors[:count], vectors[count:], temperature)
    matched = torch.where(right, log_same.detach().exp(), 0.0)
    asked = torch.rand(count, points, 2, generator=generator, device=scores.device)
    asked = asked * torch.tensor([scores.shape[-1], scores.shape[-2]], device=scores.device)
    return {
        "points": _points_loss(looking, asked, temperature),
        "keypoints": -_mean(log_same, right & (cosine == cosine.amax(1, keepdim=True))),
        **_score_losses(drawn, matched, visible, _seen(looking, drawn, count)),
    }


def draw_keypoints(scores: torch.Tensor, most: int, generator: torch.Generator) -> Drawn:
    """A keypoint of each cell of (B, H, W) scores, half of `most` the best of all cells, half any."""
    batch, height, width = scores.shape
    rows, columns = height // CELL_PX, width // CELL_PX
    cells = scores.reshape(batch, rows, CELL_PX, columns, CELL_PX).permute(0, 1, 3, 2, 4)
    logits = cells.reshape(batch, rows * columns, CELL_PX * CELL_PX)
    log_share = torch.log_softmax(logits, -1)
    drawn = torch.multinomial(log_share.detach().exp().flatten(0, 1), 1, generator=generator).reshape(
        batch, -1, 1
    )
    value, log_chosen = logits.gather(2, drawn)[..., 0], log_share.gather(2, drawn)[..., 0]
    luck = torch.rand(value.shape, generator=generator, device=value.device)
    best = value.detach().topk(most // 2, dim=1).indices
    kept = torch.cat([best, luck.scatter(1, best, -1.0).topk(most - most // 2, dim=1).indices], dim=1)
    inside = drawn[..., 0].gather(1, kept)
    x = (kept % columns) * CELL_PX + inside % CELL_PX
    y = (kept // columns) * CELL_PX + inside // CELL_PX
    pixels = torch.stack([x, y], dim=-1).float() + 0.5
    return Drawn(pixels, value.gather(1, kept), log_chosen.gather(1, kept))


class _Looking:
    """A batch's maps, and where its pixels are in the world."""

    def __init__(
        self,
        network: KeypointNet,
        maps: Maps,
        shifts: torch.Tensor,
        panoramas: Panoramas,
        pairs: torch.Tensor,
    ) -> None:
        self._network, self._maps, self._shifts = network, maps, shifts.float()
        self._panoramas, self._pairs = panoramas, pairs
        self._grid = grid_of(panoramas.ranges_m.shape[-2])
        self.height_px = panoramas.strips.shape[-2]

    def descriptors(self, pixels: torch.Tensor) -> torch.Tensor:
        """Of (2P, K, 2) pixels."""
        moved = pixels + torch.tensor([PAD_COLUMNS, 0.0], device=pixels.device)
        return described(self._maps, self._network.strides, moved)

    def bearings(self, pixels: torch.Tensor, part: slice = slice(None)) -> torch.Tensor:
        """Unit vectors of pixels of the pictures of a part, in the cameras' frames."""
        return bearings(self._lonlat(pixels[part], self._shifts[part]))

    def expected(
        self, pixels: torch.Tensor, *, back: bool = False
    ) -> tuple[torch.Tensor, torch.Tensor, torch.Tensor]:
        """Where (P, K, 2) pixels here are there, see `Panoramas.seen_from`; `back`: of those there, here."""
        count = len(self._pairs)
        here, there = self._pairs.T.flip(0) if back else self._pairs.T
        part = self._shifts[count:] if back else self._shifts[:count]
        return self._panoramas.seen_from(self._lonlat(pixels, part), here, there)

    def pixels_there(self, directions: torch.Tensor) -> torch.Tensor:
        """(P, K, 2) pixels of bearings in the pictures there."""
        turns = lonlat(directions)
        grid, shifts = self._grid, self._shifts[len(self._pairs) :]
        x = (grid.width * (0.5 - turns[..., 0] / (2.0 * torch.pi)) + shifts[:, None]) % grid.width
        y = grid.full_height * (0.5 - turns[..., 1] / torch.pi) - grid.crop_top
        return torch.stack([x, y], dim=-1)

    def _lonlat(self, pixels: torch.Tensor, shifts: torch.Tensor) -> torch.Tensor:
        x = (pixels[..., 0] - shifts[:, None]) % self._grid.width
        return lonlat_of_strip(torch.stack([x, pixels[..., 1]], dim=-1), self._grid)


def _points_loss(looking: _Looking, asked: torch.Tensor, temperature: torch.Tensor) -> torch.Tensor:
    """Of random points that both see: their descriptors, to a fraction of a pixel, are to agree."""
    seen, visible, _ = looking.expected(asked)
    there = looking.pixels_there(seen)
    inside = (there[..., 1] > 0.0) & (there[..., 1] < looking.height_px)
    vectors = looking.descriptors(torch.cat([asked, there]))
    shown = visible & inside
    log_same = _dual_softmax(vectors[: len(asked)], vectors[len(asked) :], temperature, shown)
    return -_mean(log_same.diagonal(dim1=1, dim2=2), shown)


def _seen(looking: _Looking, drawn: Drawn, count: int) -> torch.Tensor:
    """(P, K) whether the keypoints there are seen from here."""
    return looking.expected(drawn.pixels[count:], back=True)[1]


def _score_losses(
    drawn: Drawn, matched: torch.Tensor, visible: torch.Tensor, visible_back: torch.Tensor
) -> dict[str, torch.Tensor]:
    """Scores learn the share of right matches; choices that led to more than others did gain."""
    found = torch.cat([matched.sum(2), matched.sum(1)]).clamp(0.0, 1.0)
    seen = torch.cat([visible, visible_back])
    score = functional.binary_cross_entropy_with_logits(drawn.scores, found, reduction="none")
    gain = found - drawn.scores.detach().sigmoid()
    return {"score": _mean(score, seen), "choice": -_mean(gain * drawn.log_chosen, seen)}


def _dual_softmax(
    one: torch.Tensor, other: torch.Tensor, temperature: torch.Tensor, present: torch.Tensor | None = None
) -> torch.Tensor:
    likeness = temperature * (one @ other.transpose(1, 2))
    if present is not None:
        likeness = likeness.masked_fill(~present[:, None, :] | ~present[:, :, None], -1e4)
    return torch.log_softmax(likeness, 1) + torch.log_softmax(likeness, 2)


def _mean(values: torch.Tensor, where: torch.Tensor) -> torch.Tensor:
    return torch.where(where, values, 0.0).sum() / where.sum().clamp(min=1)
