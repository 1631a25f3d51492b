"""`topnav camera`: what a camera with two fisheyes needs before its first use."""

from pathlib import Path
from typing import Annotated

import typer

app = typer.Typer()
camera = typer.Typer(no_args_is_help=True, help="Calibrate a camera that gives two fisheyes in one picture.")
app.add_typer(camera, name="camera")


@camera.command()
def board(file: Annotated[Path, typer.Argument(help="A .png file, for a printer.")]) -> None:
    """Write the board that 'topnav camera calibrate' knows."""
    from services.camera.calibration.reading import write_board

    write_board(file)
    typer.echo(f"{file}: print it at any size, glue it onto something flat, take 20 pictures of it")


@camera.command()
def calibrate(
    pictures: Annotated[Path, typer.Argument(help="A folder of pictures of the board, or a video.")],
    write: Annotated[Path, typer.Option(help="Where the calibration goes.")] = Path("camera.json"),
) -> None:
    """Find out how the two fisheyes of a camera see, from pictures of the printed board."""
    from services.camera.calibration.reading import calibration_of
    from services.camera.mount.calibration_file import write_calibration

    found = calibration_of(str(pictures), typer.echo)
    write_calibration(write, found)
    sees = " and ".join(f"{lens.sees_deg:.1f}" for lens in found.lenses)
    typer.echo(
        f"{found.pictures} pictures, corners off by {found.error_px:.2f} pixels, the lenses see {sees} "
        f"degrees from their axes; use it as CAMERA?fisheye={write.absolute()}"
    )
