"""Arrays that are read by several threads at once."""

import threading
import time
from concurrent.futures import ThreadPoolExecutor

import numpy as np

from experiments.training.sealed import description, packed, unpacked


def test_threads_that_read_side_by_side_parse_one_header_at_a_time(monkeypatch):
    data = packed({"points": np.arange(6.0), "names": np.zeros((2, 3), np.uint8)}, {"world": "flat"})
    parse, inside, most = np.lib.format.read_array, threading.Semaphore(0), []

    def watched(*arguments, **options):
        inside.release()
        time.sleep(0.002)  # long enough for another thread to come in
        most.append(inside._value)
        try:
            return parse(*arguments, **options)
        finally:
            inside.acquire()

    monkeypatch.setattr(np.lib.format, "read_array", watched)
    with ThreadPoolExecutor(4) as threads:
        whole, about = threads.map(unpacked, [data] * 12), threads.map(description, [data] * 12)
        for arrays in whole:
            assert arrays.keys() == {"points", "names"}
            np.testing.assert_array_equal(arrays["points"], np.arange(6.0))
        assert all(each == {"world": "flat"} for each in about)
    assert set(most) == {1}
