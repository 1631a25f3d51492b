"""Back-off of restarts."""

from services.launcher.processes.restart import RestartPolicy

POLICY = RestartPolicy(first_s=0.3, factor=2.0, longest_s=2.0, window_s=60.0, storm_exits=3)


def test_the_first_restart_is_quick_and_later_ones_wait_twice_as_long_up_to_a_bound():
    pauses_s = [POLICY.pause_s(tuple(float(t) for t in range(n)), now_s=10.0) for n in range(1, 6)]
    assert pauses_s == [0.3, 0.6, 1.2, 2.0, 2.0]


def test_exits_of_long_ago_are_forgotten():
    assert POLICY.pause_s((0.0, 1.0, 2.0, 99.0), now_s=100.0) == 0.3
    assert POLICY.recent((40.0, 40.1), now_s=100.0) == (40.1,)


def test_a_storm_is_so_many_exits_within_the_window():
    assert not POLICY.is_storm((1.0, 2.0), now_s=3.0)
    assert POLICY.is_storm((1.0, 2.0, 3.0), now_s=3.0)
    assert not POLICY.is_storm((1.0, 2.0, 3.0), now_s=61.0)
