"""What is compared with what: conditions, plugins, sizes."""

from dataclasses import dataclass, replace

from experiments.matching.placing import Change
from services.features.pipeline.interfaces import Profile
from services.features.pipeline.named_pipelines import combined

LATITUDES_DEG = (-60.0, -45.0, -30.0, -15.0, 0.0, 15.0, 30.0, 45.0, 60.0)
LONGITUDES_DEG = (45.0, 90.0, 135.0, 180.0)
"""180 puts the picture across the seam."""
BLURS_PX = (1.0, 2.0, 4.0)
ROTATIONS_DEG = (15.0, 45.0, 90.0, 180.0)
SCALES = (0.5, 0.7, 1.4, 2.0)
"""Levels of what the thesis compares over (3.1); it states none of them (Q27)."""

DISTURBED_LATITUDES_DEG = (0.0, 45.0)
"""Where blurred, turned and scaled pictures are placed; the figure is the mean of both."""

DESCRIPTORS = (
    "sift",
    "orb",
    "beblid",
    "tfeat",
    "mkd",
    "topnav-slim",
    "topnav-hardnet",
    "topnav-sift-slim",
    "topnav-sift-hardnet",
    "topnav-keypoints",
    "aliked-t16",
    "hardnet",
    "hardnet8",
    "sosnet",
    "superpoint",
    "disk",
    "xfeat",
    "dedode",
)
REPRESENTATIONS = ("equirectangular", "tangent")
MATCHERS = ("brute_force", "mutual_ratio")
KEYPOINTS = 500
"""Of each picture, the most: nearly twice what the default pipeline takes of a whole panorama (300)."""

TIMED_PX = 2048
"""Width of the panorama whose extraction is timed: twice the running camera's."""


@dataclass(frozen=True)
class Size:
    """How much is measured."""

    images: int
    canvas_px: int
    latitudes_deg: tuple[float, ...]
    disturbances: bool


QUICK = Size(1, 1024, (0.0, 30.0, 60.0), False)
NORMAL = Size(1, 1024, (-60.0, -30.0, 0.0, 30.0, 60.0), True)
FULL = Size(2, 1024, LATITUDES_DEG, True)


def changes(size: Size) -> list[Change]:
    """All conditions."""
    found = [Change("latitude", lat, lat_deg=lat) for lat in size.latitudes_deg]
    if not size.disturbances:
        return found
    found += [Change("longitude", lon, lon_deg=lon) for lon in LONGITUDES_DEG]
    for name, levels in (("blur", BLURS_PX), ("rotation", ROTATIONS_DEG), ("scale", SCALES)):
        found += [Change(name, level, lat_deg=lat) for level in levels for lat in DISTURBED_LATITUDES_DEG]
    return found


def profile_of(descriptor: str, representation: str, matcher: str) -> Profile:
    """The thesis's settings: nothing cropped or resized, patches fitted by AffNet and turned by OriNet."""
    profile = combined(descriptor, representation, matcher)
    return replace(profile, keypoints=KEYPOINTS, crop_deg=0.0, resize=None, upright=False, affnet=True)
