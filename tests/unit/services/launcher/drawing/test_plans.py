"""Plans are drawn in the thesis's colours."""

import numpy as np
import pytest
from matplotlib.colors import to_rgb
from PIL import Image

from services.launcher.drawing.pictures import frame_from_file, picture_of, png_bytes
from services.launcher.drawing.plans import NODE, PATH, START, TARGET, VIA, Way, draw_map, draw_way
from services.launcher.drawing.world import BORDER, OBJECT
from shared.messages.maps import Edge
from shared.messages.sensors import Frame
from shared.messages.simulation import Pose
from simulator.world.world_file import load_world

POSES = {n: Pose(x_m=1.5 + n, y_m=1.2, yaw_rad=0.0) for n in range(4)}
EDGES = [Edge(a=0, b=1), Edge(a=1, b=2)]


def has(path, colour):
    pixels = np.asarray(Image.open(path).convert("RGB"), dtype=int).reshape(-1, 3)
    return bool((np.abs(pixels - np.rint(np.array(to_rgb(colour)) * 255)).max(axis=1) <= 2).any())


def test_the_map_shows_border_objects_and_nodes(tmp_path):
    draw_map(tmp_path / "map.png", load_world("apartment"), POSES, EDGES)
    assert all(has(tmp_path / "map.png", colour) for colour in (BORDER, OBJECT, NODE))
    assert not has(tmp_path / "map.png", PATH)


def test_the_way_shows_start_via_points_target_and_the_way_driven(tmp_path):
    way = Way(((1.5, 1.2), (2.5, 1.3), (3.4, 1.2)), POSES[0], POSES[3], (1, 2, -1))
    draw_way(tmp_path / "path.png", load_world("apartment"), POSES, EDGES, way)
    assert all(has(tmp_path / "path.png", colour) for colour in (START, VIA, TARGET, PATH))


def test_a_frame_keeps_its_colours_as_a_picture_and_back(tmp_path):
    blue_left = bytes([255, 0, 0, 0, 0, 255])  # BGR
    frame = Frame(robot="r1", encoding="bgr8", width_px=2, height_px=1, data=blue_left)
    assert picture_of(frame).getpixel((0, 0)) == (0, 0, 255)
    (tmp_path / "f.png").write_bytes(png_bytes(frame))
    assert frame_from_file(tmp_path / "f.png", "r1").data == blue_left


def test_a_file_that_is_no_picture_is_named(tmp_path):
    (tmp_path / "f.png").write_bytes(b"no picture")
    with pytest.raises(ValueError, match=r"f\.png is not a picture"):
        frame_from_file(tmp_path / "f.png", "r1")
