"""What `topnav camera calibrate` found out about a camera with two fisheyes, as a file."""

from pathlib import Path
from typing import Literal

import numpy as np
from pydantic import BaseModel, ConfigDict, Field, ValidationError, field_validator

from services.camera.mount.lens import Lens
from shared.geometry.sphere import FloatArray

MOST_BYTES = 100_000
"""Chosen: a calibration has two."""
ORTHONORMAL = 1e-3
"""What a rotation written with six digits is off by at most."""

Row = tuple[float, float, float]


class FisheyeLens(BaseModel):
    """One lens of the file.

    Attributes:
        rotation: R_camera_lens, rows: lens frame (x right, y down, z ahead) to camera frame (x forward, y
            left, z up).
        sees_deg: angle from its axis up to which the calibration holds.
    """

    model_config = ConfigDict(frozen=True, extra="forbid", allow_inf_nan=False)

    focal_px: float = Field(gt=1.0, lt=20_000.0)
    centre_px: tuple[float, float]
    distortion: tuple[float, float, float, float]
    rotation: tuple[Row, Row, Row]
    sees_deg: float = Field(ge=90.0, le=115.0)

    @field_validator("rotation")
    @classmethod
    def _is_one(cls, rotation: tuple[Row, Row, Row]) -> tuple[Row, Row, Row]:
        matrix = np.array(rotation)
        off = float(np.abs(matrix @ matrix.T - np.eye(3)).max())
        if off > ORTHONORMAL or np.linalg.det(matrix) < 0.0:
            raise ValueError(f"a rotation expected, got rows that are off by {off:.3g}")
        return rotation

    @property
    def lens(self) -> Lens:
        """The lens itself."""
        return Lens(self.focal_px, self.centre_px, self.distortion)

    @property
    def rotation_camera_lens(self) -> FloatArray:
        """R_camera_lens, (3, 3)."""
        return np.array(self.rotation, dtype=np.float64)


class FisheyeCalibration(BaseModel):
    """Two lenses in one picture.

    Attributes:
        error_px: root mean square of what corners of the board are off by.
        pictures: how many pictures it was calibrated with.
    """

    model_config = ConfigDict(frozen=True, extra="forbid", allow_inf_nan=False)

    format: Literal["topnav-fisheye-1"] = "topnav-fisheye-1"
    width_px: int = Field(ge=64, le=16_384)
    height_px: int = Field(ge=64, le=8_192)
    lenses: tuple[FisheyeLens, FisheyeLens]
    error_px: float = Field(ge=0.0)
    pictures: int = Field(ge=1)

    def scaled(self, width_px: int) -> "FisheyeCalibration":
        """The same camera when its pictures have so many columns."""
        factor = width_px / self.width_px
        lenses = tuple(
            lens.model_copy(
                update={
                    "focal_px": lens.focal_px * factor,
                    "centre_px": (lens.centre_px[0] * factor, lens.centre_px[1] * factor),
                }
            )
            for lens in self.lenses
        )
        size = {"width_px": width_px, "height_px": round(self.height_px * factor)}
        return self.model_copy(update={**size, "lenses": lenses})


class CalibrationFileError(ValueError):
    """A file that is no calibration; the text says what was expected."""


def load_calibration(path: Path) -> FisheyeCalibration:
    """Read a calibration.

    Raises:
        CalibrationFileError: it is not there, too long, or says something else.
    """
    try:
        with path.open("rb") as file:
            data = file.read(MOST_BYTES + 1)
    except OSError as error:
        raise CalibrationFileError(
            f"{path}: {error.strerror}: 'topnav camera calibrate' writes such a file"
        ) from error
    if len(data) > MOST_BYTES:
        raise CalibrationFileError(f"{path}: at most {MOST_BYTES} bytes expected of a calibration")
    try:
        return FisheyeCalibration.model_validate_json(data)
    except ValidationError as error:
        first = error.errors()[0]
        where = ".".join(map(str, first["loc"])) or "the file"
        raise CalibrationFileError(
            f"{path}: no calibration of 'topnav camera calibrate': {where}: {first['msg']}"
        ) from error


def write_calibration(path: Path, calibration: FisheyeCalibration) -> None:
    """Write in one step, so that a reader never sees half of it."""
    path.parent.mkdir(parents=True, exist_ok=True)
    new = path.with_name(path.name + ".new")
    new.write_text(calibration.model_dump_json(indent=2) + "\n", encoding="utf-8")
    new.replace(path)
