"""The life of one service, with a made-up process, health and clock."""

import signal

import pytest

from services.launcher.compose.local import ProcessSpec
from services.launcher.processes.restart import RestartPolicy
from services.launcher.processes.runner import HUNG_AFTER_S, ServiceRunner, State

POLICY = RestartPolicy(first_s=0.3, factor=2.0, longest_s=5.0, window_s=60.0, storm_exits=3, settle_s=5.0)


class FakeChild:
    def __init__(self, pid):
        self.pid, self.code, self.signals = pid, None, []

    def exit_code(self):
        return self.code

    def send(self, number):
        self.signals.append(number)


class FakeHealth:
    def __init__(self):
        self.alive = frozenset()

    def __call__(self):
        return self.alive


class Bench:
    """A runner with everything around it in the test's hand."""

    def __init__(self, restart=True, ready_after_s=0.0):
        spec = ProcessSpec("a", ("x",), {}, (), "a", None, 0.0, ready_after_s, {}, restart, 1.0)
        self.children, self.health = [], FakeHealth()
        self.runner = ServiceRunner(spec, self.health, self.spawn, POLICY)

    def spawn(self, _spec):
        self.children.append(FakeChild(100 + len(self.children)))
        return self.children[-1]

    def step(self, now_s, may_start=True, watch_hung=True):
        self.runner.step(now_s, may_start, watch_hung)
        return self.runner.state

    def healthy(self, token="t1"):
        self.step(0.0)
        self.health.alive = frozenset({token})
        assert self.step(0.1) is State.HEALTHY


@pytest.fixture
def bench():
    return Bench()


def test_it_waits_for_what_it_needs_then_starts_then_is_healthy(bench):
    assert bench.step(0.0, may_start=False) is State.WAITING
    assert bench.children == []
    assert bench.step(1.0) is State.STARTING
    assert not bench.runner.satisfies(must_be_healthy=True)
    assert bench.runner.satisfies(must_be_healthy=False)
    bench.health.alive = frozenset({"t1"})
    assert bench.step(2.0) is State.HEALTHY
    assert bench.runner.satisfies(must_be_healthy=True)


def test_a_killed_process_starts_again_after_the_first_pause_even_if_what_it_needs_is_gone(bench):
    bench.healthy()
    bench.children[0].code = -signal.SIGKILL
    assert bench.step(10.0) is State.RESTARTING
    assert (bench.runner.last_exit, bench.runner.restarts, bench.runner.pid) == (-9, 1, None)
    assert bench.step(10.29, may_start=False) is State.RESTARTING
    assert bench.step(10.31, may_start=False) is State.STARTING
    assert len(bench.children) == 2


def test_the_token_of_the_dead_process_does_not_make_the_new_one_healthy(bench):
    bench.healthy("old")
    bench.children[0].code = 1
    bench.step(10.0)
    bench.step(11.0)  # starts while "old" still lingers on the bus
    assert bench.step(11.1) is State.STARTING
    bench.health.alive = frozenset({"old", "new"})
    assert bench.step(11.2) is State.HEALTHY


def test_a_crash_storm_degrades_but_goes_on_trying_and_recovery_must_last(bench):
    now_s = 0.0
    bench.step(now_s)
    for _ in range(3):
        bench.children[-1].code = 1
        now_s += 0.1
        state = bench.step(now_s)
        now_s += 3.0
        bench.step(now_s)
    assert state is State.DEGRADED
    assert len(bench.children) == 4
    bench.health.alive = frozenset({"new"})
    assert bench.step(now_s + 1.0) is State.DEGRADED
    assert bench.step(now_s + 5.1) is State.HEALTHY


def test_what_a_dead_process_left_in_its_group_is_killed(bench):
    bench.healthy()
    bench.children[0].code = 1
    bench.step(1.0)
    assert bench.children[0].signals == [signal.SIGKILL]


def test_a_silent_process_is_killed_after_a_while_and_not_while_the_bus_is_down(bench):
    bench.healthy()
    bench.health.alive = frozenset()
    assert bench.step(1.0) is State.SILENT
    bench.step(HUNG_AFTER_S + 5.0, watch_hung=False)
    bench.step(HUNG_AFTER_S + 6.0)
    assert bench.children[0].signals == []
    bench.step(2 * HUNG_AFTER_S + 6.0)
    assert bench.children[0].signals == [signal.SIGKILL]


def test_a_silent_process_that_speaks_again_is_healthy(bench):
    bench.healthy()
    bench.health.alive = frozenset()
    bench.step(1.0)
    bench.health.alive = frozenset({"t1"})
    assert bench.step(2.0) is State.HEALTHY


def test_a_service_without_a_health_check_must_have_run_for_a_while():
    bench = Bench(ready_after_s=0.5)
    bench.step(0.0)
    bench.health.alive = frozenset({"now"})
    assert bench.step(0.4) is State.STARTING
    assert bench.step(0.6) is State.HEALTHY


def test_a_service_that_must_not_restart_stays_down():
    bench = Bench(restart=False)
    bench.healthy()
    bench.children[0].code = 0
    assert bench.step(1.0) is State.EXITED
    assert bench.step(100.0) is State.EXITED
    assert len(bench.children) == 1
