"""Pictures as the thesis's library takes them: a path, an OpenCV image or a torch image."""

from pathlib import Path
from typing import Any

import cv2
import numpy as np
import numpy.typing as npt

Image = npt.NDArray[np.uint8]


def picture_of(info: Any) -> Image:
    """Bytes (H, W) or (H, W, 3), BGR.

    Args:
        info: path of a file; array (H, W) or (H, W, 3) of bytes; torch tensor (H, W), (3, H, W) or
            (1, 3, H, W), RGB, bytes or 0 to 1.

    Raises:
        ValueError: none of these; the text says what came.
    """
    if isinstance(info, str | Path):
        picture = cv2.imread(str(info), cv2.IMREAD_COLOR)
        if picture is None:
            raise ValueError(f"img_info must be a picture that OpenCV reads, got the path {str(info)!r}")
        return np.asarray(picture, np.uint8)
    if hasattr(info, "detach"):
        return _of_tensor(info)
    array = np.asarray(info)
    if array.dtype != np.uint8 or array.ndim not in (2, 3) or (array.ndim == 3 and array.shape[2] != 3):
        raise ValueError(f"img_info must be bytes (H, W) or (H, W, 3), got {array.dtype} {array.shape}")
    return array


def resized(picture: Image, resize: list[int]) -> Image:
    """The picture with [rows, columns] of `resize`; [-1] leaves it as it is.

    Raises:
        ValueError: `resize` is neither.
    """
    if list(resize) == [-1]:
        return picture
    if len(resize) != 2 or min(resize) < 16:
        raise ValueError(f"resize must be [rows, columns] of at least 16, or [-1], got {resize}")
    rows, columns = resize
    return np.asarray(cv2.resize(picture, (columns, rows), interpolation=cv2.INTER_AREA), np.uint8)


def _of_tensor(tensor: Any) -> Image:
    array = tensor.detach().cpu().numpy()
    array = array[0] if array.ndim == 4 and len(array) == 1 else array
    if array.ndim == 3 and array.shape[0] in (1, 3):
        array = array.transpose(1, 2, 0)
        array = array[..., ::-1] if array.shape[2] == 3 else array[..., 0]
    if array.ndim not in (2, 3):
        raise ValueError(f"img_info as a tensor must be (H, W), (3, H, W) or (1, 3, H, W), got {array.shape}")
    if array.dtype != np.uint8:
        array = np.clip(np.rint(array * 255.0), 0, 255).astype(np.uint8)
    return np.ascontiguousarray(array)
