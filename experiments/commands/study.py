"""`topnav study`: the thesis's studies and ours."""

import typer

from experiments.commands import (
    changes,
    cycles,
    disturbance,
    disturbance_matches,
    failures,
    heading,
    heading_frames,
    inspection,
    keypoints,
    latency,
    localisation,
    matching,
    phone_photos,
    photographs,
    recovery,
    scale,
)

app = typer.Typer(
    name="study", no_args_is_help=True, help="Experiments on headings, matching, disturbances and scale."
)
for study in (
    changes,
    heading,
    heading_frames,
    inspection,
    keypoints,
    latency,
    localisation,
    cycles,
    disturbance,
    disturbance_matches,
    failures,
    matching,
    phone_photos,
    photographs,
    recovery,
    scale,
):
    app.add_typer(study.app)
