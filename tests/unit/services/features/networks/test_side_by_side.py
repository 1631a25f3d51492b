"""Pictures shared out among threads of one core each."""

import threading

import pytest

torch = pytest.importorskip("torch")

from services.features.networks.side_by_side import SideBySide  # noqa: E402

CPU = torch.device("cpu")


@pytest.fixture
def two_cores():
    before = torch.get_num_threads()
    torch.set_num_threads(2)
    yield
    torch.set_num_threads(before)


@pytest.mark.usefixtures("two_cores")
@pytest.mark.parametrize("count", [0, 1, 2, 3, 8])
def test_every_item_has_its_result_in_its_place(count):
    doubled = SideBySide(CPU).map(lambda part: [2 * item for item in part], list(range(count)))
    assert doubled == [2 * item for item in range(count)]


@pytest.mark.usefixtures("two_cores")
def test_two_threads_of_one_core_each_work_at_once():
    both = threading.Barrier(2)

    def work(part):
        both.wait(timeout=10.0)
        return [(len(part), torch.get_num_threads(), threading.get_ident())] * len(part)

    found = SideBySide(CPU).map(work, list(range(8)))
    assert {(size, cores) for size, cores, _ in found} == {(4, 1)}
    assert len({thread for _, _, thread in found}) == 2


@pytest.mark.usefixtures("two_cores")
def test_whoever_else_computes_has_all_cores_as_before():
    SideBySide(CPU).map(lambda part: list(part), [1, 2])
    elsewhere = []
    later = threading.Thread(target=lambda: elsewhere.append(torch.get_num_threads()))
    later.start()
    later.join()
    assert (torch.get_num_threads(), elsewhere) == (2, [2])


def test_a_machine_of_one_core_and_a_gpu_get_all_at_once():
    before = torch.get_num_threads()
    torch.set_num_threads(1)
    try:
        one = SideBySide(CPU)
    finally:
        torch.set_num_threads(before)
    for side_by_side in (one, SideBySide(torch.device("cuda"))):
        assert side_by_side.map(lambda part: [len(part)] * len(part), [1, 2, 3]) == [3, 3, 3]


@pytest.mark.usefixtures("two_cores")
def test_what_a_thread_raises_comes_back():
    with pytest.raises(ValueError, match="invalid literal"):
        SideBySide(CPU).map(lambda part: [int(item) for item in part], ["1", "two"])
