"""The models in the wheel read a plate as the simulator draws it, without any network."""

import socket

import numpy as np
import pytest

from services.signs.recognition import TextReader
from simulator.textures.lettering import plate


def test_a_plate_is_read_with_its_corners_and_nothing_is_downloaded(monkeypatch: pytest.MonkeyPatch):
    def nobody(*_: object, **__: object) -> None:
        raise AssertionError("something was asked for over the network")

    monkeypatch.setattr(socket, "getaddrinfo", nobody)
    monkeypatch.setattr(socket.socket, "connect", nobody)
    picture = np.full((240, 320, 3), 200, np.uint8)
    small = plate("214", 1.5, (24, 26, 30), (242, 242, 238))[::8, ::8]
    picture[100 : 100 + small.shape[0], 150 : 150 + small.shape[1]] = small
    (line,) = TextReader(threads=1)(picture)
    assert line.text == "214"
    assert line.confidence > 0.97
    assert line.corners.mean(axis=0) == pytest.approx(
        (150 + small.shape[1] / 2, 100 + small.shape[0] / 2), abs=3
    )
    assert TextReader(threads=1)(np.full((240, 320, 3), 200, np.uint8)) == []
