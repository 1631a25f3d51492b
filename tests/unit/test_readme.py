"""What the README and the pages in deploy show is what the repository holds and what the code accepts."""

import re

import numpy as np
import pytest

from services.features.pipeline.extraction import extract
from services.features.pipeline.interfaces import Profile
from services.features.pipeline.plugins import create_representation
from tests.readme import PAGES, README, REPOSITORY, examples

FEATURES_PAGE = REPOSITORY / "deploy" / "FEATURES.md"
SETTINGS_PAGE = REPOSITORY / "deploy" / "SETTINGS.md"
VARIABLE = re.compile(r"`(TOPNAV_[A-Z_]+)`")
LINK = re.compile(r"\]\((?!https?:)([^)#]+)\)")


@pytest.mark.parametrize("page", PAGES, ids=lambda page: str(page.relative_to(REPOSITORY)))
def test_links_and_pictures_lead_to_files(page):
    targets = LINK.findall(page.read_text(encoding="utf-8"))
    assert [target for target in targets if not (page.parent / target).exists()] == []


def test_the_extractor_works_as_a_plugin():
    (source,) = examples("python", FEATURES_PAGE)
    names: dict[str, type] = {}
    exec(compile(source, FEATURES_PAGE, "exec"), names)
    profile = Profile("brisk", keypoints=50)
    picture = np.random.default_rng(1).integers(0, 255, (128, 256, 3), dtype=np.uint8)
    features = extract(picture, names["Brisk"](profile), create_representation(profile), profile)
    assert features.descriptors.shape == (50, 64)


NAMED = {
    name for page in (README, SETTINGS_PAGE) for name in VARIABLE.findall(page.read_text(encoding="utf-8"))
}


@pytest.mark.parametrize("variable", sorted(NAMED))
def test_the_settings_named_exist(repository, variable):
    places = [repository / "docker-compose.yml", *(repository / "services/launcher").rglob("*.py")]
    assert any(variable in place.read_text(encoding="utf-8") for place in places)
