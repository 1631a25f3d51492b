"""Commands are as old as the frame they answer."""

from simulator.service import MOST_AGE_S, CommandAge


def age_of(*frames):
    age = CommandAge()
    for seq, sent_s in frames:
        age.sent(seq, sent_s)
    return age


def test_answers_to_recent_frames_count_and_older_ones_do_not():
    age = age_of((1, 0.0), (2, 1.0), (3, 2.0))
    now_s = MOST_AGE_S + 0.5
    assert [age.recent(seq, now_s) for seq in (1, 2, 3)] == [False, True, True]


def test_the_newest_frame_counts_however_long_the_next_one_takes():
    assert age_of((3, 0.0)).recent(3, 1000.0)


def test_frames_that_never_went_out_do_not_count():
    assert not age_of((3, 0.0)).recent(4, 0.0)
    assert not CommandAge().recent(0, 0.0)
