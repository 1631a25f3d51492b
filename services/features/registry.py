"""Plugin name -> class, imported only when chosen: a classic pipeline loads no learned one's libraries."""

from importlib import import_module
from typing import Any

from services.features.pipelines import Profile

PLUGINS: dict[str, dict[str, str]] = {
    "extractor": {
        "sift": "services.features.extractors.sift:Sift",
        "orb": "services.features.extractors.orb:Orb",
        "beblid": "services.features.extractors.beblid:Beblid",
    },
    "representation": {
        "equirectangular": "services.features.representations.equirectangular:Equirectangular",
        "tangent": "services.features.representations.tangent:Tangent",
        "planar": "services.features.representations.planar:Planar",
    },
    "matcher": {
        "mutual_ratio": "services.features.matchers.mutual_ratio:MutualRatio",
        "brute_force": "services.features.matchers.brute_force:BruteForce",
    },
}


def create(kind: str, name: str, *arguments: Any) -> Any:
    """Import and build one plugin.

    Raises:
        ValueError: no plugin of this kind has this name; the text lists those there are.
    """
    choices = PLUGINS[kind]
    if name not in choices:
        raise ValueError(f"{kind} must be one of {sorted(choices)}, got {name!r}")
    module, attribute = choices[name].split(":")
    return getattr(import_module(module), attribute)(*arguments)


def create_extractor(profile: Profile) -> Any:
    """Build the profile's extractor."""
    return create("extractor", profile.extractor, profile)


def create_representation(profile: Profile) -> Any:
    """Build the profile's representation."""
    return create("representation", profile.representation, profile)


def create_matcher(profile: Profile, distance: str) -> Any:
    """Build the profile's matcher for descriptors compared by `distance`."""
    return create("matcher", profile.matcher, profile, distance)
