"""Plugin name -> class, imported only when chosen: a classic pipeline loads no learned one's libraries."""

from dataclasses import dataclass
from importlib import import_module
from typing import Any

from services.features.pipeline.named_pipelines import Profile
from services.features.pipeline.plugins import CLASSIC, PLUGINS


@dataclass(frozen=True)
class Runtime:
    """Where and how learned plugins run.

    Attributes:
        device: cpu or cuda.
        trained: load trained weights; False leaves what torch's generator draws, to test shapes.
    """

    device: str = "cpu"
    trained: bool = True


def create(kind: str, name: str, *arguments: Any, **options: Any) -> Any:
    """Import and build one plugin.

    Raises:
        ValueError: no plugin of this kind has this name; the text lists those there are.
    """
    choices = PLUGINS[kind]
    if name not in choices:
        raise ValueError(f"{kind} must be one of {sorted(choices)}, got {name!r}")
    module, attribute = choices[name].split(":")
    return getattr(import_module(module), attribute)(*arguments, **options)


def create_extractor(profile: Profile, runtime: Runtime) -> Any:
    """Build the profile's extractor."""
    if profile.extractor in CLASSIC:
        return create("extractor", profile.extractor, profile)
    return create("extractor", profile.extractor, profile, runtime.device, trained=runtime.trained)


def create_representation(profile: Profile) -> Any:
    """Build the profile's representation."""
    return create("representation", profile.representation, profile)


def create_matcher(profile: Profile, distance: str, runtime: Runtime) -> Any:
    """Build the profile's matcher for descriptors compared by `distance`."""
    if profile.matcher in ("mutual_ratio", "brute_force"):
        return create("matcher", profile.matcher, profile, distance)
    return create("matcher", profile.matcher, profile, distance, runtime.device, trained=runtime.trained)
