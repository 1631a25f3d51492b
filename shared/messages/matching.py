"""Compare one frame with map nodes. Planner, gateway -> features and back."""

from typing import Annotated, ClassVar, Literal

from pydantic import Field, model_validator

from shared.messages.arrays import Array, ArraySpec
from shared.messages.base import Bearing, Message, Name, Part
from shared.messages.features import MAX_KEYPOINTS, Features

DIFFERENCES_SHAPE = (16, 64)
"""Rows and columns in which differences of two pictures are told: 5.6 degrees each."""

TwoViewStatus = Literal["ok", "no_baseline", "too_few", "inconsistent"]


class MatchRequest(Message):
    """Compare the robot's frame `seq` (or `features`) with nodes of a map and with `targets`.

    Attributes:
        features: compare these instead of the robot's frame.
        node_ids: nodes to compare with, each verified.
        best_k: also the k most similar nodes of the whole map, each verified.
        targets: pictures outside the map (a goal); reported with node_id -1, -2, ... in order.
        with_matches: send the matched bearings, not only their count.
        with_differences: look at the pictures of the nodes in `node_ids` too, of those that are near.
        map_revision: the answer must know the map at least as of this revision.
    """

    SCHEMA: ClassVar[str] = "match_request.v1"
    MAX_ITEMS: ClassVar[int] = 10_000

    map: Name
    map_revision: int = Field(default=0, ge=0)
    features: Features | None = None
    node_ids: tuple[int, ...] = Field(default=(), max_length=4096, fail_fast=True)
    best_k: int = Field(default=0, ge=0, le=4096)
    targets: tuple[Features, ...] = Field(default=(), max_length=16, fail_fast=True)
    with_matches: bool = True
    with_differences: bool = False


class NodeMatch(Part):
    """How the frame relates to one node.

    Attributes:
        raw_matches: matches of descriptors alone, without those that a matcher calls doubtful.
        inliers: S, those of them that agree with one camera motion.
        heading_rad: direction from the frame to the node, camera frame of the frame; None if unknown.
        yaw_rad: rotation from the frame's camera to the node's, counter-clockwise.
        disparity_rad: change of bearings after yaw: falls to zero on arrival.
        confidence: probability that heading_rad is right to 20 degrees, as far as one pair of views tells.
        noise_rad: spread of the inliers about the motion: what only looks alike stands a little differently.
        moved: inliers whose bearing changed by more than 2 degrees beside the camera's turn: the others are
            far away and look alike from many places.
        differences: of a target near by, or of such a node where asked for, how much of it differs that no
            way explains, in levels of the Lab colour space: rows from 45 degrees up to 45 down, columns as in
            its picture; None without a thumbnail.
        matches_rad: (M, 4) lon, lat in the frame, then lon, lat in the node, all matches.
        inlier_mask: (M,) 1 where the match is an inlier.
        right: (M,) probability that each match is right, by its descriptors; of a photo only.
        log_scale: (M,) ln of each keypoint's size in the photo over that in the node; of a photo only.
    """

    node_id: int
    raw_matches: int = Field(ge=0)
    inliers: int = Field(ge=0)
    status: TwoViewStatus
    heading_rad: Bearing | None = None
    heading_std_rad: float | None = None
    yaw_rad: Bearing | None = None
    disparity_rad: float | None = None
    confidence: float = Field(default=0.0, ge=0.0, le=1.0)
    noise_rad: float | None = Field(default=None, ge=0.0)
    moved: int | None = Field(default=None, ge=0)
    differences: Annotated[Array, ArraySpec(("float32",), DIFFERENCES_SHAPE)] | None = None
    matches_rad: Annotated[Array, ArraySpec(("float32",), (None, 4), MAX_KEYPOINTS)] | None = None
    inlier_mask: Annotated[Array, ArraySpec(("uint8",), (None,), MAX_KEYPOINTS)] | None = None

    right: Annotated[Array, ArraySpec(("float32",), (None,), MAX_KEYPOINTS)] | None = None
    log_scale: Annotated[Array, ArraySpec(("float32",), (None,), MAX_KEYPOINTS)] | None = None

    @model_validator(mode="after")
    def _mask_fits(self) -> "NodeMatch":
        if (self.matches_rad is None) != (self.inlier_mask is None):
            raise ValueError("matches_rad and inlier_mask come together")
        if self.matches_rad is None or self.inlier_mask is None:
            return self
        if len(self.matches_rad) != len(self.inlier_mask):
            raise ValueError("matches_rad and inlier_mask must have one length")
        beside = [each for each in (self.right, self.log_scale) if each is not None]
        if any(len(each) != len(self.matches_rad) for each in beside):
            raise ValueError("right and log_scale must have one number per match")
        return self


class MatchReply(Message):
    """One entry per compared node, most similar first."""

    SCHEMA: ClassVar[str] = "match_reply.v1"
    MAX_ITEMS: ClassVar[int] = 200_000

    map: Name
    map_revision: int = Field(default=0, ge=0)
    pipeline: str = ""
    max_similarity: int = Field(default=0, ge=0)
    results: tuple[NodeMatch, ...] = Field(default=(), fail_fast=True)
    match_ms: float = 0.0
    verify_ms: float = 0.0
