"""Our matcher as a plugin: which frames it looks at, and which of the network's answers are matches."""

import numpy as np
import pytest

torch = pytest.importorskip("torch")

from services.features.matchers.mutual_ratio import MutualRatio  # noqa: E402
from services.features.matchers.topnav import COUNTED, LEAST_RIGHT, LOOKED_AT, AttentionMatcher  # noqa: E402
from services.features.networks.attention import Assignment  # noqa: E402
from services.features.pipeline.extraction import extract  # noqa: E402
from services.features.pipeline.interfaces import FeatureSet, Profile, Runtime  # noqa: E402
from services.features.pipeline.named_pipelines import combined  # noqa: E402
from services.features.pipeline.pipeline import Pipeline  # noqa: E402
from shared.geometry.sphere import wrap_rad  # noqa: E402

PROFILE = Profile("sift", matcher="topnav-attention")


class Answers:
    """In place of the network: the same answer to every pair, and how many it was asked for."""

    def __init__(self, right, elsewhere=()):
        self.right, self.elsewhere, self.asked = right, elsewhere, 0

    def last(self, one, others, hopeless):
        assert 0.0 < hopeless < 0.1
        assert one.descriptors.shape[0] == 1
        assert torch.allclose(one.descriptors.norm(dim=-1), torch.tensor(1.0), atol=1e-3)
        count = len(others.descriptors)
        self.asked += count
        if self.right is None:
            return [], None
        numbers = [number for number in range(count) if number not in self.elsewhere]
        log_right = torch.log(torch.tensor(self.right, dtype=torch.float32)).expand(len(numbers), -1, -1)
        return numbers, Assignment(log_right, (torch.zeros(count, 2),) * 2, torch.zeros(count, 3))


@pytest.fixture
def matcher():
    torch.manual_seed(1)
    return AttentionMatcher(PROFILE, "euclidean", Runtime(trained=False))


def test_trained_it_finds_the_turn_between_two_views(room):
    pipeline = Pipeline(combined("sift", "equirectangular", "topnav-attention"))
    picture = room(0.0, 0.0, 0.0, 400)
    here, there = (
        extract(view, pipeline.extractor, pipeline.representation, pipeline.profile)
        for view in (picture, np.roll(picture, 80, axis=1))
    )
    (found,) = pipeline.matcher.match(here, [there])
    moved = there.lonlat_rad[found.pairs[:, 1], 0] - here.lonlat_rad[found.pairs[:, 0], 0]
    assert len(found) > 100
    assert np.mean(np.abs(wrap_rad(moved + np.deg2rad(36.0))) < np.deg2rad(1.0)) > 0.9


def some(count: int, seed: int) -> FeatureSet:
    rng = np.random.default_rng(seed)
    lonlat = rng.uniform([-3.0, -1.0], [3.0, 1.0], (count, 2)).astype(np.float32)
    descriptors = rng.integers(0, 255, (count, 128)).astype(np.float32)
    return FeatureSet(lonlat, np.full(count, 0.1, np.float32), descriptors, np.full(count, 0.05, np.float32))


def test_matches_are_mutual_likely_and_carry_their_probability(matcher):
    matcher._network = Answers([[0.9, 0.02, 0.01], [0.4, 0.3, 0.01], [0.01, 0.01, LEAST_RIGHT / 2]])
    (found,) = matcher.match(some(3, 1), [some(3, 2)])
    assert found.pairs.tolist() == [[0, 0]]
    assert found.right == pytest.approx([0.9])


def test_what_is_less_likely_than_what_counts_is_doubtful(matcher):
    unsure = (LEAST_RIGHT + COUNTED) / 2.0
    matcher._network = Answers([[0.9, 0.01, 0.01], [0.01, unsure, 0.01], [0.01, 0.01, COUNTED + 0.01]])
    (found,) = matcher.match(some(3, 1), [some(3, 2)])
    assert found.doubtful.tolist() == [False, True, False]
    assert (len(found), found.count(), found.count(np.array([False, True, True]))) == (3, 2, 1)


def test_another_place_has_no_matches(matcher):
    matcher._network = Answers(None)
    (found,) = matcher.match(some(3, 1), [some(3, 2)])
    assert (len(found), found.pairs.shape) == (0, (0, 2))


def test_of_several_frames_only_another_place_has_no_matches(matcher):
    matcher._network = Answers([[0.9]], elsewhere=(0, 2))
    query = some(1, 1)
    found = matcher.match(query, [query, query, query, query])
    assert [len(one) for one in found] == [0, 1, 0, 1]


def test_of_many_frames_those_most_alike_are_looked_at_and_the_others_keep_their_neighbours(matcher):
    query = some(20, 1)
    alike = [FeatureSet(query.lonlat_rad[:n], query.scores[:n], query.descriptors[:n]) for n in range(3, 15)]
    matcher._network = Answers(None)
    found = matcher.match(query, alike)
    plain = MutualRatio(PROFILE, "euclidean").match(query, alike)
    assert matcher._network.asked == LOOKED_AT
    beyond = len(alike) - LOOKED_AT
    for one, other in zip(found[:beyond], plain[:beyond], strict=True):
        np.testing.assert_array_equal(one.pairs, other.pairs)
    assert [len(one) for one in found[beyond:]] == [0] * LOOKED_AT


def test_frames_of_other_lengths_are_matched_together_as_each_by_itself(matcher):
    query, others = some(30, 1), [some(count, count) for count in (30, 12, 25)]
    together = matcher.match(query, others)
    for other, found in zip(others, together, strict=True):
        (alone,) = matcher.match(query, [other])
        np.testing.assert_array_equal(found.pairs, alone.pairs)
        np.testing.assert_allclose(found.right, alone.right, rtol=1e-3)
        assert found.pairs[:, 1].max(initial=0) < len(other)


def test_frames_without_keypoints_have_no_matches_and_are_not_looked_at(matcher):
    matcher._network = Answers([[0.9]])
    nothing = some(0, 3)
    assert [len(one) for one in matcher.match(some(4, 1), [nothing])] == [0]
    assert [len(one) for one in matcher.match(nothing, [some(4, 1)])] == [0]
    assert matcher.match(some(4, 1), []) == []
    assert matcher._network.asked == 0


def test_a_network_that_learned_nothing_answers_all_the_same(matcher):
    (found,) = matcher.match(some(40, 1), [some(30, 2)])
    assert found.pairs.shape[1:] == (2,)
    assert len(np.unique(found.pairs[:, 0])) == len(found) == len(found.right)
