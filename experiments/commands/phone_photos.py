"""`topnav study phone-photos`: where ordinary photos are said to be taken, and which way they look."""

from typing import Annotated

import typer

from experiments.work.record import on_record
from services.launcher.terminal import options

app = typer.Typer()


@app.command("phone-photos")
@on_record("study phone-photos")
def phone_photos(
    world: options.World = "apartment",
    map_name: options.MapName = "flat",
    pictures: Annotated[int, typer.Option(min=1, help="Photos to ask about.")] = 60,
    height_m: Annotated[float, typer.Option(min=0.3, max=2.5, help="Of the phone above the floor.")] = 0.8,
    unmapped: Annotated[bool, typer.Option("--unmapped", help="From parts the map does not show.")] = False,
    seed: options.Seed = 1,
    json_file: options.JsonFile = None,
    data_dir: options.DataDir = options.DATA_DIR,
) -> int:
    """Take phone pictures anywhere in a mapped world and ask where they were taken.

    A place within a metre and a direction within 20 degrees is right; another one named alone is wrong. Half
    of the pictures do not tell their field of view. Asks the core in this process: no stack runs.
    """
    import numpy as np

    from experiments.localisation.poses import poses_of
    from experiments.phone_photos.asking import ask, read_map
    from experiments.phone_photos.judging import judge, summary
    from experiments.phone_photos.taking import shots_at, taken
    from experiments.rendered.frames import simulated
    from services.launcher.client.failure import ExperimentError
    from services.launcher.evaluation.truth_file import load_truth, truth_path
    from services.launcher.terminal.output import print_rows, write_json
    from shared.geometry.photo.plane import USUAL_RAD
    from simulator.settings import CameraSettings
    from simulator.world.freespace import free_space
    from simulator.world.world_file import load_world

    truth = load_truth(truth_path(data_dir, map_name))
    if truth is None:
        raise ExperimentError(f"no map {map_name!r} explored in {data_dir}: run 'topnav explore' there first")
    known, place = read_map(data_dir, map_name), load_world(world)
    rng = np.random.default_rng(seed)
    poses = poses_of(free_space(place).random_pose, truth.poses.values(), pictures, rng, mapped=not unmapped)
    simulation = simulated(place, CameraSettings(width_px=2048, face_scale=0.35, height_m=height_m))
    rows = []
    for shot in shots_at(poses, rng):
        photo = taken(shot, lambda at: simulation.panorama_at(at.x_m, at.y_m, at.yaw_rad), USUAL_RAD)
        rows.append(judge(shot, ask(known, map_name, photo), truth.poses))
    told = {"world": world, "map": map_name, "seed": seed, "height_m": height_m, "unmapped": unmapped}
    write_json(json_file, {**told, "summary": summary(rows), "photos": rows})
    print_rows("photos", rows)
    print_rows("summary", [summary(rows)])
    return len(rows)
