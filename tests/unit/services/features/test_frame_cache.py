"""New, again or stale: retransmission, restart of the camera, late frames."""

import numpy as np
import pytest

from services.features.frame_cache import RESTARTED_FRAMES, FrameCache, FrameKey
from shared.messages.features import Features
from shared.messages.sensors import Frame


def features(seq: int) -> Features:
    return Features(
        seq=seq,
        pipeline="sift",
        lonlat_rad=np.zeros((0, 2), np.float32),
        scores=np.zeros(0, np.float32),
        descriptors=np.zeros((0, 128), np.uint8),
    )


def frame(seq: int) -> Frame:
    return Frame(seq=seq, robot="r1", encoding="bgr8", width_px=2, height_px=1, data=bytes(6))


@pytest.fixture
def cache() -> FrameCache:
    kept = FrameCache(capacity=3)
    for seq in range(5, 10):
        kept.put(FrameKey(seq, 100 * seq, 0), features(seq), frame(seq))
    return kept


def test_only_the_newest_are_kept(cache):
    assert [seq for seq in range(12) if cache.get(seq) is not None] == [7, 8, 9]
    assert cache.span() == "7 to 9"


def test_a_frame_is_kept_as_long_as_its_features(cache):
    assert [seq for seq in range(12) if cache.frame(seq) == frame(seq)] == [7, 8, 9]
    assert cache.frame(6) is None


def test_only_a_frame_newer_than_all_is_ahead(cache):
    assert [seq for seq in range(4, 12) if cache.is_ahead(seq)] == [10, 11]
    assert FrameCache(capacity=3).is_ahead(0)


@pytest.mark.parametrize("lockstep", [True, False])
def test_the_same_picture_is_sent_again_without_work(cache, lockstep):
    key = FrameKey(9, 900, 0)
    assert cache.judge(key, lockstep) == "again"
    assert cache.same(key).seq == 9


@pytest.mark.parametrize(
    ("key", "lockstep", "verdict"),
    [
        pytest.param(FrameKey(10, 1000, 0), False, "new", id="next frame"),
        pytest.param(FrameKey(6, 600, 0), False, "stale", id="late frame"),
        pytest.param(FrameKey(8, 800, 0), False, "stale", id="an older frame once more"),
        pytest.param(FrameKey(8, 800, 0), True, "again", id="an older frame once more in lockstep"),
        pytest.param(FrameKey(9, 900, 1), False, "stale", id="other picture of the same number and time"),
        pytest.param(FrameKey(0, 950, 0), False, "new", id="restarted camera, clock moved on"),
        pytest.param(FrameKey(0, 0, 0), True, "new", id="restarted camera in lockstep, clock back at zero"),
        pytest.param(FrameKey(9, 900, 1), True, "new", id="reset simulator, other picture"),
    ],
)
def test_judgement(cache, key, lockstep, verdict):
    assert cache.judge(key, lockstep) == verdict


def test_numbers_of_before_a_restart_are_forgotten(cache):
    cache.put(FrameKey(0, 950, 0), features(0), frame(0))
    assert cache.get(9) is None
    assert cache.get(0) is not None


def test_a_camera_that_restarted_with_its_clock_set_back_is_believed_after_some_frames(cache):
    verdicts = [cache.judge(FrameKey(seq, seq, 0), lockstep=False) for seq in range(RESTARTED_FRAMES + 1)]
    assert verdicts == ["stale"] * RESTARTED_FRAMES + ["new"]


def test_late_frames_in_no_order_stay_late_however_many(cache):
    for number in range(5 * RESTARTED_FRAMES):
        assert cache.judge(FrameKey((8, 7, 6)[number % 3], 1, 1), lockstep=False) == "stale"


def test_an_empty_cache_takes_anything():
    assert FrameCache(1).judge(FrameKey(0, 0, 0), lockstep=False) == "new"
    assert FrameCache(1).span() == "none"


def test_the_key_tells_pictures_apart_by_content():
    fields = {"robot": "r1", "encoding": "bgr8", "width_px": 2, "height_px": 1}
    one, other = Frame(data=b"abcdef", **fields), Frame(data=b"abcdeg", **fields)
    assert FrameKey.of(one) != FrameKey.of(other)
