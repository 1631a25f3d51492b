"""Every plugin's name and class, imported when it is chosen: `sift` loads no network's libraries."""

from importlib import import_module
from typing import Any

from services.features.pipeline.interfaces import (
    Distance,
    Extractor,
    Matcher,
    Profile,
    Representation,
    Runtime,
)

CLASSIC = {"sift": "Sift", "orb": "Orb", "beblid": "Beblid"}
PATCH_NETWORKS = {
    "tfeat": "TFeat",
    "hardnet": "HardNet",
    "hardnet8": "HardNet8",
    "sosnet": "SosNet",
    "mkd": "Mkd",
    "topnav-slim": "Slim",
    "topnav-hardnet": "FullHardNet",
}
SIFT_NETWORKS = {"topnav-sift-slim": "SiftSlim", "topnav-sift-hardnet": "SiftHardNet"}
"""Networks that describe patches round SIFT's keypoints."""
KEYPOINT_NETWORKS = {
    "aliked-t16": "Aliked",
    "aliked-n16": "Aliked",
    "aliked-n16rot": "Aliked",
    "aliked-n32": "Aliked",
    "disk": "Disk",
    "xfeat": "XFeat",
    "dedode": "DeDoDe",
    "superpoint": "SuperPoint",
    "topnav-keypoints": "Keypoints",
}
OWN_MATCHERS = {"topnav-attention": "AttentionMatcher"}
"""Trained here, as are the extractors whose names begin with topnav: nobody is to take one for another's."""
CLASSIC_MATCHERS = {"mutual_ratio": "MutualRatio", "brute_force": "BruteForce"}
PLUGINS = {
    "extractor": CLASSIC | PATCH_NETWORKS | SIFT_NETWORKS | KEYPOINT_NETWORKS,
    "representation": {"equirectangular": "Equirectangular", "tangent": "Tangent", "planar": "Planar"},
    "matcher": CLASSIC_MATCHERS
    | OWN_MATCHERS
    | {"lightglue": "LightGlue", "superglue": "SuperGlue", "superglue-outdoor": "SuperGlue"},
}
"""Kind -> name -> class. A file in the kind's folder has the plugin's name, without what follows a dash."""


def create(kind: str, name: str, *arguments: Any) -> Any:
    """Import and build one plugin.

    Raises:
        ValueError: no plugin of this kind has this name; the text lists those there are.
    """
    choices = PLUGINS[kind]
    if name not in choices:
        raise ValueError(f"{kind} must be one of {sorted(choices)}, got {name!r}")
    module = import_module(f"services.features.{kind}s.{name.partition('-')[0]}")
    return getattr(module, choices[name])(*arguments)


def create_extractor(profile: Profile, runtime: Runtime) -> Extractor:
    """Build the profile's extractor."""
    where = () if profile.extractor in CLASSIC else (runtime,)
    built: Extractor = create("extractor", profile.extractor, profile, *where)
    return built


def create_representation(profile: Profile) -> Representation:
    """Build the profile's representation."""
    built: Representation = create("representation", profile.representation, profile)
    return built


def create_matcher(profile: Profile, distance: Distance, runtime: Runtime) -> Matcher:
    """Build the profile's matcher for descriptors compared by `distance`."""
    where = () if profile.matcher in CLASSIC_MATCHERS else (runtime,)
    built: Matcher = create("matcher", profile.matcher, profile, distance, *where)
    return built
