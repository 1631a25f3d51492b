"""From how many verified matches on a picture is taken to be in the map."""

from experiments.scale.refusal import Refusal, calibrated, refusal_curve


def test_errors_of_each_threshold():
    curve = refusal_curve(own=[50, 40, 9, 60], foreign=[3, 12, 5, 4])
    assert curve[0] == Refusal(0, 1.0, 0.0)
    assert curve[10] == Refusal(10, 0.25, 0.25)
    assert curve[13] == Refusal(13, 0.0, 0.25)
    assert curve[61] == Refusal(61, 0.0, 1.0)


def test_the_calibrated_threshold_lies_in_the_middle_of_the_best():
    assert calibrated(refusal_curve(own=[30, 40], foreign=[10, 4])) == Refusal(21, 0.0, 0.0)


def test_where_both_overlap_the_fewest_errors_win():
    best = calibrated(refusal_curve(own=[20, 30, 40, 50], foreign=[1, 2, 3, 25]))
    assert best.false_accept + best.false_reject == 0.25
