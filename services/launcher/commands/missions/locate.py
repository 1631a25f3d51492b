"""`topnav locate`: where in a map an ordinary photo was taken, without driving there."""

from pathlib import Path
from typing import Annotated

import typer

from services.launcher.terminal import options

app = typer.Typer()


@app.command()
def locate(
    photo: Annotated[Path, typer.Option(help="An ordinary photo.")],
    field_of_view_deg: options.FieldOfView = None,
    map_name: options.MapName = "flat",
    world: options.World = "apartment",
    json_file: options.JsonFile = None,
    pipeline: options.PipelineName = None,
    data_dir: options.DataDir = options.DATA_DIR,
    endpoint: options.Endpoint = None,
    timeout_s: options.TimeoutS = options.START_TIMEOUT_S,
) -> None:
    """Say where in a map an ordinary photo was taken, and which way it looks."""
    import math

    from services.launcher.client import maps, stack
    from services.launcher.client.photo import locate_photo, photo_from_file
    from services.launcher.terminal.output import print_figures, print_rows, rounded, write_json

    picture = photo_from_file(photo, field_of_view_deg)
    choice = stack.StackChoice(data_dir, world, pipeline=pipeline, endpoint=endpoint, timeout_s=timeout_s)
    with stack.open_stack(choice) as opened:
        known = maps.require_map(opened, map_name)
        answer = locate_photo(opened.bus, opened.robot, known, picture).answer
    rows = [
        {
            "node": place.node,
            "ahead_m": rounded(place.x_m, 2),
            "left_m": rounded(place.y_m, 2),
            "looks_deg": rounded(math.degrees(place.yaw_rad), 1),
            "field_of_view_deg": rounded(math.degrees(place.fov_rad), 1),
            "keypoints": place.keypoints,
            "score": rounded(place.score, 1),
        }
        for place in answer.places
    ]
    report = {"map": map_name, "photo": str(photo), "verdict": answer.verdict}
    write_json(json_file, {**report, "places": rows})
    print_figures(f"locate {photo.name}", report)
    print_rows("places, as from their nearest node", rows)
