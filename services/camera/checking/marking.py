"""A panorama with the horizon and the four directions marked, for a person to look at. Pure."""

import cv2
import numpy as np
import numpy.typing as npt

from shared.geometry.sphere import EquirectGrid, FloatArray

Image = npt.NDArray[np.uint8]

WIDTH_PX = 1600
"""Of the marked picture; chosen: fits a screen."""
HORIZON, FOUND, DARK = (0, 220, 255), (255, 0, 255), (0, 0, 0)
"""Yellow, magenta and black, BGR."""
NAMES = ((0.5, "AHEAD"), (0.25, "LEFT"), (0.75, "RIGHT"), (0.0, "BEHIND"))
POINTS = 400


def marked(panorama: Image, up: FloatArray | None) -> Image:
    """Draw over a panorama.

    Args:
        panorama: (H, 2H, 3) BGR, as frames are.
        up: where up was found, unit vector (3,); its horizon is drawn, too.
    """
    size = WIDTH_PX, WIDTH_PX // 2
    picture = np.asarray(cv2.resize(panorama, size, interpolation=cv2.INTER_AREA), dtype=np.uint8)
    middle = size[1] // 2
    cv2.line(picture, (0, middle), (size[0], middle), HORIZON, 1)
    if up is not None:
        for column, row in _horizon(up):
            cv2.circle(picture, (column, row), 2, FOUND, -1)
    for share, name in NAMES:
        column = round(share * size[0])
        cv2.line(picture, (column, 0), (column, size[1]), HORIZON, 1)
        _write(picture, name, (column + 6, 24))
    _write(picture, "yellow: horizon as frames have it", (6, size[1] - 34))
    if up is not None:
        _write(picture, "magenta: horizon by upright edges", (6, size[1] - 12))
    return picture


def _horizon(up: FloatArray) -> npt.NDArray[np.intp]:
    """Pixels (N, 2) of the great circle at right angles to up."""
    ahead = np.array([1.0, 0.0, 0.0]) - up[0] * up
    ahead /= np.linalg.norm(ahead)
    turns = np.linspace(0.0, 2.0 * np.pi, POINTS, endpoint=False)[:, None]
    circle = np.cos(turns) * ahead + np.sin(turns) * np.cross(up, ahead)
    return np.asarray(EquirectGrid(WIDTH_PX, WIDTH_PX // 2).pixels_from_bearings(circle), dtype=np.intp)


def _write(picture: Image, text: str, place: tuple[int, int]) -> None:
    (width, height), below = cv2.getTextSize(text, cv2.FONT_HERSHEY_SIMPLEX, 0.6, 1)
    x, y = place
    cv2.rectangle(picture, (x - 2, y - height - 2), (x + width + 2, y + below), DARK, -1)
    cv2.putText(picture, text, place, cv2.FONT_HERSHEY_SIMPLEX, 0.6, HORIZON, 1, cv2.LINE_AA)
