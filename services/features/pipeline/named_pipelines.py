"""Named pipelines: which plugins work together, with which figures. Pure data, nothing heavy is imported."""

from dataclasses import replace

from services.features.pipeline.interfaces import Profile
from services.features.pipeline.plugins import PLUGINS

_PHOTO = Profile(
    "sift", keypoints=1000, ratio=0.95, crop_deg=35.0, resize=(800, 1600), surroundings=2.0, promising=5.0
)
"""For pictures that are further apart than a robot's, of cameras that lean (decision 0031)."""

# Verified matches (medians of 14 pairs of apartment frames each), by distance of the two frames in metres:
#   keypoints   0.2-0.5  0.5-1  1-1.5  1.5-2  2-2.5  2.5-3.5   pairs with a direction
#   sift 150         76     54     26     26     18       14      95 %
#   sift 300        132     84     48     42     26       23     100 %
#   sift 500        209    131     72     60     38       36     100 %
#   orb 300         116     60     21     27     16       10      88 %
# 300 is the default: 500 gave no more directions, and matching grows with the square of the count.
PROFILES: dict[str, Profile] = {
    "sift": Profile("sift"),
    "fast": Profile("sift"),
    "photo": _PHOTO,
    "photo_topnav": replace(_PHOTO, extractor="topnav-sift-hardnet"),
    "sift_dense": Profile("sift", keypoints=500),
    "thesis": Profile("sift", keypoints=150),
    "orb": Profile("orb"),
    "beblid": Profile("beblid"),
    "sift_tangent": Profile("sift", representation="tangent", resize=None),
    "orb_tangent": Profile("orb", representation="tangent", resize=None),
    "beblid_tangent": Profile("beblid", representation="tangent", resize=None),
    "sift_planar": Profile("sift", representation="planar"),
    "superpoint_superglue": Profile("superpoint", matcher="superglue", keypoints=150),
    "topnav_attention": Profile("topnav-keypoints", matcher="topnav-attention", keypoints=150),
}

LIGHTGLUE = {
    "aliked-n16": "aliked",
    "aliked-n16rot": "aliked",
    "aliked-n32": "aliked",
    "disk": "disk",
    "dedode": "dedodeb",
    "xfeat": "xfeat",
    "superpoint": "superpoint",
}
"""Extractors for which somebody trained a LightGlue -> kornia's name of those weights."""


ATTENTION = {"sift": "topnav-attention-sift", "topnav-keypoints": "topnav-attention-keypoints"}
"""Extractors for whose keypoints our matcher was trained -> its weights."""


def find_profile(name: str) -> Profile:
    """Return a named profile, or one put together as extractor[/representation[/matcher]].

    Raises:
        ValueError: no such name or plugin, or plugins that do not work together; the text says why.
    """
    if name in PROFILES:
        return PROFILES[name]
    extractor, representation, matcher, *rest = [*name.split("/"), "", "", ""][: max(3, name.count("/") + 1)]
    if extractor not in PLUGINS["extractor"] or rest:
        raise ValueError(
            f"pipeline must be one of {sorted(PROFILES)} or extractor[/representation[/matcher]] "
            f"with an extractor of {sorted(PLUGINS['extractor'])}, got {name!r}"
        )
    for kind, value in (("representation", representation), ("matcher", matcher)):
        if value and value not in PLUGINS[kind]:
            raise ValueError(
                f"{kind} of pipeline {name!r} must be one of {list(PLUGINS[kind])}, got {value!r}"
            )
    return combined(extractor, representation or "equirectangular", matcher or "mutual_ratio")


def combined(extractor: str, representation: str, matcher: str) -> Profile:
    """Profile of three plugins.

    Raises:
        ValueError: the matcher was not trained for the extractor.
    """
    if matcher.startswith("superglue") and extractor != "superpoint":
        raise ValueError(f"matcher {matcher} was trained for superpoint alone, not for {extractor}")
    if matcher == "lightglue" and extractor not in LIGHTGLUE:
        raise ValueError(f"there is no lightglue for {extractor}, only for {', '.join(LIGHTGLUE)}")
    if matcher == "topnav-attention" and extractor not in ATTENTION:
        raise ValueError(f"there is no topnav-attention for {extractor}, only for {', '.join(ATTENTION)}")
    resize = None if representation == "tangent" else (400, 800)
    return Profile(extractor, representation, matcher, resize=resize)
