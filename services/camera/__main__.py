"""Entry point: `python -m services.camera`."""

import sys
from functools import partial

from services.camera.mount.calibration_file import CalibrationFileError
from services.camera.service import run
from services.camera.settings import CameraSettings
from services.camera.streaming.video import silence_libraries
from shared.lifecycle import run_service


def main() -> None:
    """Run the camera service until a signal; a calibration that cannot be used ends it with one line."""
    settings = CameraSettings.of_service("camera")
    silence_libraries()
    try:
        run_service("camera", settings, partial(run, settings))
    except CalibrationFileError as error:
        sys.exit(f"camera: {error}")


if __name__ == "__main__":
    main()
