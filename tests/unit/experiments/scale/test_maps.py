"""Maps larger than the world: real nodes first, then nodes whose features are all real."""

import numpy as np

from experiments.scale.maps import nodes_of, put_together
from services.features.pipeline.interfaces import FeatureSet

WORDS = 60


def seen(number: int) -> FeatureSet:
    """A place whose descriptors say which place it is."""
    rng = np.random.default_rng(number)
    lonlat = np.stack([rng.uniform(-np.pi, np.pi, WORDS), rng.uniform(-1, 1, WORDS)], axis=1)
    scores = np.sort(rng.random(WORDS, dtype=np.float32))[::-1]
    return FeatureSet(lonlat.astype(np.float32), scores, np.full((WORDS, 4), number, np.uint8))


def test_the_real_places_come_first_and_the_rest_is_made_of_four():
    real = [seen(n) for n in range(6)]
    places = list(nodes_of(real, 9, np.random.default_rng(1)))
    assert len(places) == 9
    assert all(place is other for place, other in zip(places, real, strict=False))
    assert all(1 < len(np.unique(place.descriptors)) <= 4 for place in places[6:])


def test_no_more_places_than_asked_for():
    assert len(list(nodes_of([seen(n) for n in range(6)], 4, np.random.default_rng(1)))) == 4


def test_each_direction_shows_one_of_the_sources_and_the_strongest_keypoints_come_first():
    sources = [seen(n) for n in range(4)]
    made = put_together(sources, np.random.default_rng(3))
    assert (np.diff(made.scores) <= 0).all()
    assert len(made) <= WORDS
    around = np.argsort(made.lonlat_rad[:, 0])
    changes = np.count_nonzero(np.diff(made.descriptors[around, 0]))
    assert changes <= 4
    for source in sources:
        of_source = {tuple(row) for row in source.lonlat_rad.tolist()}
        number = source.descriptors[0, 0]
        assert all(
            tuple(row) in of_source for row in made.lonlat_rad[made.descriptors[:, 0] == number].tolist()
        )
