"""Command-line options that several commands share."""

import json
from pathlib import Path
from typing import Annotated, Any

import typer

World = Annotated[str, typer.Option(help="A world that comes with topnav, or a .yaml file.")]
MapName = Annotated[str, typer.Option("--map", help="Name of the map.")]
Seed = Annotated[int, typer.Option(min=0, help="Of every random draw.")]
JsonFile = Annotated[Path | None, typer.Option("--json", help="Write the figures to this file.")]
AsJson = Annotated[bool, typer.Option("--json", help="Print JSON instead of a table.")]
Lockstep = Annotated[
    bool | None,
    typer.Option(help="As fast as the machine allows, same seed, same path. Default for a stack of its own."),
]
ProfileName = Annotated[
    str | None, typer.Option("--profile", help="Rules of planner and drive: default, thesis, or a file.")
]
PipelineName = Annotated[str | None, typer.Option("--pipeline", help="Feature pipeline, for example sift.")]
DataDir = Annotated[
    Path, typer.Option(envvar="TOPNAV_DATA_DIR", help="Maps and logs; a stack that runs there is joined.")
]
StackDir = Annotated[Path, typer.Option(envvar="TOPNAV_DATA_DIR", help="Maps, logs and state live here.")]
Endpoint = Annotated[
    str | None, typer.Option(help="Join the stack whose router is here, for example tcp/127.0.0.1:7447.")
]
MaxSteps = Annotated[int, typer.Option(min=1, help="Give a mission up after so many frames.")]
TimeoutS = Annotated[
    float,
    typer.Option(min=1.0, envvar="TOPNAV_START_TIMEOUT_S", help="How long a start of the stack may take."),
]

FieldOfView = Annotated[
    float | None,
    typer.Option(
        "--field-of-view-deg",
        min=20.0,
        max=130.0,
        help="Of the photo, over its longer side; else its EXIF counts, or it is found.",
    ),
]

Robot = Annotated[str, typer.Option(help="Name of the robot.")]
Kind = Annotated[str, typer.Argument(help="One of 'topnav mission kinds'.")]
Given = Annotated[
    list[str] | None,
    typer.Option("--set", help="A parameter of the kind, as NAME=VALUE; may be given often."),
]

DATA_DIR = Path("data")
RUNS_DIR = Path("runs")
START_TIMEOUT_S = 300.0
"""Chosen: ten times what a large world takes to load on two busy cores."""


def named_value(text: str) -> tuple[str, Any]:
    """NAME=VALUE; a value is JSON where it can be read as such, else text."""
    name, separator, value = text.partition("=")
    if not name or not separator:
        raise typer.BadParameter(f"--set expects NAME=VALUE, got {text!r}")
    try:
        return name, json.loads(value)
    except ValueError:
        return name, value
