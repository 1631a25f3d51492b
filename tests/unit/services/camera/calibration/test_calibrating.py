"""A camera with two known fisheyes, calibrated from pictures of the printed board that it takes."""

import math

import cv2
import numpy as np
import pytest
from typer.testing import CliRunner

from services.camera.calibration.board import COLUMNS, ROWS, corners_in, drawn_board
from services.camera.calibration.calibrating import CalibrationError, calibrated, view_in
from services.camera.calibration.reading import calibration_of
from services.camera.mount.calibration_file import FisheyeCalibration, load_calibration
from services.camera.mount.orientation import Orientation
from services.camera.mount.table import from_fisheyes
from services.launcher.cli import app
from shared.geometry.perspective import pixel_centres
from tests.fisheye_camera import FRONT_BACK

SQUARE_PX = 60
FINE = 2


def rays(camera: FisheyeCalibration) -> np.ndarray:
    """Bearings (H, W, 3) of all pixels of both lenses, camera frame; NaN where no lens looks."""
    fine = camera.scaled(FINE * camera.width_px)
    found = np.full((fine.height_px, fine.width_px, 3), np.nan)
    half = fine.width_px // 2
    for number, one in enumerate(fine.lenses):
        bearings = one.lens.bearings(pixel_centres(half, fine.height_px) + np.array([number * half, 0.0]))
        bearings[bearings[..., 2] < math.cos(math.radians(one.sees_deg))] = np.nan
        found[:, number * half : (number + 1) * half] = bearings @ one.rotation_camera_lens.T
    return found


def picture_of(bearings: np.ndarray, turn: np.ndarray, place: np.ndarray, rng) -> np.ndarray:
    """The board at a pose in the camera's frame, in squares, with a sensor's noise."""
    local = bearings @ turn
    origin = place @ turn
    reach = origin[2] / local[..., 2]
    at = local[..., :2] * reach[..., None] - origin[:2]
    at[~(reach > 0.0)] = -99.0
    board = drawn_board(SQUARE_PX)
    u, v = ((at + 0.5) * SQUARE_PX - 0.5).astype(np.float32).transpose(2, 0, 1)
    fine = cv2.remap(board, u, v, cv2.INTER_LINEAR, borderMode=cv2.BORDER_CONSTANT, borderValue=(90,))
    grey = cv2.resize(fine, None, fx=1 / FINE, fy=1 / FINE, interpolation=cv2.INTER_AREA)
    noisy = np.clip(grey + rng.normal(0.0, 2.0, grey.shape), 0, 255).astype(np.uint8)
    return cv2.cvtColor(noisy, cv2.COLOR_GRAY2BGR)


def held(azimuth, lift, far, roll, lean):
    """Pose of a board that somebody holds: its middle in a direction, facing the camera, leaning."""
    ahead = np.array([math.cos(lift) * math.cos(azimuth), math.cos(lift) * math.sin(azimuth), math.sin(lift)])
    x = np.cross(ahead, [0.0, 0.0, 1.0])
    x /= np.linalg.norm(x)
    facing = np.column_stack([x, np.cross(ahead, x), ahead])
    turn = (
        facing @ cv2.Rodrigues(np.array([0.0, lean, 0.0]))[0] @ cv2.Rodrigues(np.array([0.0, 0.0, roll]))[0]
    )
    return turn, far * ahead - turn[:, :2] @ np.array([COLUMNS / 2, ROWS / 2])


@pytest.fixture(scope="module")
def pictures():
    rng, bearings = np.random.default_rng(3), rays(FRONT_BACK)
    poses = [
        held(k * math.pi / 8, lift, 6.0, 0.2 * k, 0.3 * (-1) ** k) for k in range(16) for lift in (-0.2,)
    ]
    poses += [held(k * math.pi / 3, 0.7 * (-1) ** k, 6.0, 0.5, 0.2) for k in range(6)]
    poses += [held(side * math.pi / 2, lift, 5.0, lift, 0.1) for side in (1, -1) for lift in (-0.5, 0.2, 0.6)]
    return [picture_of(bearings, *pose, rng) for pose in poses]


@pytest.fixture(scope="module")
def views(pictures):
    return [view_in(picture) for picture in pictures]


def worst_deg(found: FisheyeCalibration) -> float:
    """The worst error of a bearing up to 85 degrees from an axis."""
    rng = np.random.default_rng(1)
    bearings = rng.normal(size=(20_000, 3))
    bearings /= np.linalg.norm(bearings, axis=1, keepdims=True)
    worst = 0.0
    for true, ours in zip(FRONT_BACK.lenses, found.lenses, strict=True):
        pixels, theta = true.lens.pixels(bearings @ true.rotation_camera_lens)
        away = theta < math.radians(85.0)
        seen = ours.lens.bearings(pixels[away]) @ ours.rotation_camera_lens.T
        off = np.degrees(np.arccos(np.clip(np.sum(seen * bearings[away], axis=1), -1.0, 1.0)))
        worst = max(worst, float(off.max()))
    return worst


def test_the_command_finds_bearings_to_a_fifth_of_a_degree_away_from_the_seam(pictures, tmp_path):
    for number, picture in enumerate(pictures):
        cv2.imwrite(str(tmp_path / f"{number:02}.png"), picture)
    file = tmp_path / "camera.json"
    run = CliRunner().invoke(app, ["camera", "calibrate", str(tmp_path), "--write", str(file)])
    assert run.exit_code == 0, run.output
    found = load_calibration(file)
    assert worst_deg(found) <= 0.2


def test_what_is_remapped_by_the_found_table_lies_where_the_true_one_puts_it(views):
    found = calibrated(views, (FRONT_BACK.width_px, FRONT_BACK.height_px))
    places = np.random.default_rng(4).uniform(0, 255, (50, 100, 3)).astype(np.uint8)
    scene = cv2.resize(places, (1600, 800), interpolation=cv2.INTER_CUBIC)
    tables = [from_fisheyes(1024, one, Orientation()).applied(scene) for one in (FRONT_BACK, found)]
    grey = [cv2.cvtColor(one, cv2.COLOR_BGR2GRAY) for one in tables]
    flow = cv2.calcOpticalFlowFarneback(grey[0], grey[1], None, 0.5, 3, 21, 5, 7, 1.5, 0)
    ahead = flow[128:384, 300:724]  # within 75 degrees of the first axis
    assert np.percentile(np.hypot(ahead[..., 0], ahead[..., 1]), 99) * 360 / 1024 <= 0.2


def test_a_folder_without_pictures_is_named(tmp_path):
    with pytest.raises(CalibrationError, match=r"a folder with \.jpg or \.png pictures expected"):
        calibration_of(str(tmp_path), print)


def test_pictures_of_two_sizes_are_refused(tmp_path):
    for name, width in (("a.png", 400), ("b.png", 200)):
        cv2.imwrite(str(tmp_path / name), np.zeros((200, width, 3), np.uint8))
    with pytest.raises(CalibrationError, match="pictures of one size expected, picture 2 has 200 x 200"):
        calibration_of(str(tmp_path), lambda _: None)


def test_the_board_that_is_printed_is_the_one_that_is_found(tmp_path):
    file = tmp_path / "board.png"
    assert CliRunner().invoke(app, ["camera", "board", str(file)]).exit_code == 0
    small = cv2.resize(cv2.imread(str(file)), (600, 420), interpolation=cv2.INTER_AREA)
    corners = corners_in(small, 0, 600)
    assert corners is not None
    assert len(corners.points) == (COLUMNS - 1) * (ROWS - 1)


def test_too_few_pictures_say_what_to_add(views):
    with pytest.raises(CalibrationError, match="hold it nearer, in better light, and beside the camera"):
        calibrated(views[:4], (FRONT_BACK.width_px, FRONT_BACK.height_px))


def test_boards_that_no_lens_explains_are_no_calibration(views):
    rng = np.random.default_rng(2)
    bent = []
    for view in views:
        for corners in view:
            if corners is not None:
                corners = type(corners)(
                    corners.points, corners.pixels + rng.normal(0.0, 9.0, corners.pixels.shape)
                )
            bent.append(corners)
    pairs = list(zip(bent[::2], bent[1::2], strict=True))
    with pytest.raises(CalibrationError):
        calibrated(pairs, (FRONT_BACK.width_px, FRONT_BACK.height_px))
