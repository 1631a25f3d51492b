"""Velocities are as old as the frame they answer."""

from simulator.service import MOST_AGE_S, RecentFrames


def sent(*frames):
    frames_sent = RecentFrames()
    for seq, sent_s in frames:
        frames_sent.sent(seq, sent_s)
    return frames_sent


def test_answers_to_recent_frames_count_and_older_ones_do_not():
    frames_sent = sent((1, 0.0), (2, 1.0), (3, 2.0))
    now_s = MOST_AGE_S + 0.5
    assert [frames_sent.has(seq, now_s) for seq in (1, 2, 3)] == [False, True, True]


def test_the_newest_frame_counts_however_long_the_next_one_takes():
    assert sent((3, 0.0)).has(3, 1000.0)


def test_frames_that_never_went_out_do_not_count():
    assert not sent((3, 0.0)).has(4, 0.0)
    assert not RecentFrames().has(0, 0.0)
