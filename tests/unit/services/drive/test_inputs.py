"""How old frames are: counted from the first news of them, whatever clocks say."""

from services.drive.inputs import MOST_FRAMES, FrameAges


def test_a_frame_is_as_old_as_the_first_news_of_it():
    ages = FrameAges()
    for seq, now_s in ((4, 10.0), (4, 10.1), (5, 10.2), (7, 10.4)):
        ages.heard(seq, now_s)
    assert ages.age_s(4, 11.0) == 1.0
    assert abs(ages.age_s(6, 11.0) - 0.6) < 1e-9, "its news was lost, that of the next frame was heard"


def test_a_frame_before_the_first_news_is_at_least_as_old_as_that():
    ages = FrameAges()
    ages.heard(100, 5.0)
    assert ages.age_s(3, 8.0) == 3.0


def test_a_frame_that_was_not_heard_of_yet_is_new():
    ages = FrameAges()
    assert ages.age_s(1, 50.0) == 0.0
    ages.heard(1, 50.0)
    assert ages.age_s(2, 60.0) == 0.0


def test_a_restarted_robot_counts_anew():
    ages = FrameAges()
    ages.heard(900, 1.0)
    ages.heard(1, 20.0)
    assert ages.age_s(1, 21.0) == 1.0
    assert ages.age_s(900, 21.0) == 0.0


def test_its_memory_is_bounded():
    ages = FrameAges()
    for seq in range(5 * MOST_FRAMES):
        ages.heard(seq, float(seq))
    assert len(ages._seqs) <= MOST_FRAMES
    assert ages.age_s(5 * MOST_FRAMES - 10, 5.0 * MOST_FRAMES) == 10.0
