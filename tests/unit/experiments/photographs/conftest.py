"""A tour rendered once for all tests here, and small ones made by hand."""

import json
from pathlib import Path

import cv2
import numpy as np
import pytest


@pytest.fixture(scope="session")
def example(tmp_path_factory) -> Path:
    """Folder of a rendered tour of four pictures."""
    from experiments.photographs.example import render_example
    from simulator.world.world_file import load_world

    folder = tmp_path_factory.mktemp("example")
    return render_example(load_world("apartment"), folder, pictures=4, seed=1).parent


@pytest.fixture
def write_tour(tmp_path):
    """Write a tour of grey pictures; fields given replace those of a tour without faults."""

    def write(name: str = "flat", size_px: tuple[int, int] = (64, 32), **fields: object) -> Path:
        tour = {
            "name": name,
            "pictures": ["a", "b", "c"],
            "links": [{"from": "a", "to": "b", "bearing_deg": 10.0}],
            "rooms": {"a": "room_1", "b": "room_1", "c": "room_2"},
        } | fields
        folder = tmp_path / name
        folder.mkdir()
        for picture in ("a", "b", "c"):
            cv2.imwrite(str(folder / f"{picture}.png"), np.zeros((size_px[1], size_px[0], 3), np.uint8))
        path = folder / "tour.json"
        path.write_text(json.dumps(tour), encoding="utf-8")
        return path

    return write
