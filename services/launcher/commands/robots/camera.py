"""`topnav camera`: what a camera needs before its first use, a look at what it delivers and a calibration."""

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from services.launcher.terminal import options

if TYPE_CHECKING:
    from services.camera.checking.report import Report

app = typer.Typer()
camera = typer.Typer(no_args_is_help=True, help="What a camera delivers; calibrate two fisheyes.")
app.add_typer(camera, name="camera")


@camera.command()
def check(
    url: Annotated[
        str | None, typer.Argument(envvar="TOPNAV_CAMERA", help="A camera's URL, as osc://192.168.1.1.")
    ] = None,
    seconds: Annotated[
        float | None,
        typer.Option(min=1.0, max=600.0, help="How long to look at it.", show_default="3, 10 with --flash"),
    ] = None,
    flash: Annotated[
        bool,
        typer.Option("--flash", help="Measure the delay: this terminal turns bright and dark."),
    ] = False,
    picture: Annotated[
        Path, typer.Option(help="Where a picture with horizon and directions marked goes, .png or .jpg.")
    ] = Path("camera-check.png"),
    seed: options.Seed = 0,
    json_file: options.JsonFile = None,
) -> None:
    """Say what a camera delivers, by the CAMERA_* settings, and what is wrong; exit 1 where something is."""
    import os

    from services.camera.checking.checking import check_camera
    from services.launcher.terminal.output import write_json

    if url is not None:
        os.environ["CAMERA_URL"] = url
    usual_s = 10.0 if flash else 3.0
    try:
        report, marked = check_camera(seconds or usual_s, _paint if flash else None, seed)
    finally:
        if flash:
            typer.echo("\x1b[0m\x1b[2J\x1b[H", nl=False)
    if marked is not None:
        picture.write_bytes(marked(picture.suffix))
    write_json(json_file, report.figures())
    _tell(report, picture if marked is not None else None)


def _paint(bright: bool) -> None:
    """Fill the terminal with white or black."""
    import sys

    sys.stdout.write(f"\x1b[{107 if bright else 40}m\x1b[2J\x1b[H")
    sys.stdout.flush()


def _tell(report: "Report", picture: Path | None) -> None:
    from services.camera.checking.report import lines, problems

    for word, text in lines(report):
        typer.echo(f"{word:9} {text}")
    if picture is not None:
        typer.echo(
            f"{'picture':9} {picture}: is AHEAD ahead, is LEFT left, can you read what is written there?"
        )
    wrong = problems(report)
    for one in wrong:
        typer.echo(f"{'wrong':9} {one}")
    raise typer.Exit(1 if wrong else 0)


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
