"""`topnav study localisation`: where pictures from anywhere are said to be, without any history."""

from typing import Annotated

import typer

from experiments.work.record import on_record
from services.launcher.terminal import options

app = typer.Typer()


@app.command("localisation")
@on_record("study localisation")
def localisation(
    world: options.World = "hostel",
    map_name: options.MapName = "flat",
    pictures: Annotated[int, typer.Option(min=1, help="Pictures to ask about.")] = 40,
    unmapped: Annotated[bool, typer.Option("--unmapped", help="From parts the map does not show.")] = False,
    seed: options.Seed = 1,
    json_file: options.JsonFile = None,
    data_dir: options.DataDir = options.DATA_DIR,
    timeout_s: options.TimeoutS = options.START_TIMEOUT_S,
) -> int:
    """Take pictures anywhere and ask goal-check, as a robot that is switched on somewhere must.

    The right node, or a list that has it, is right; a single wrong one would be believed.
    """
    import httpx
    import numpy as np

    from experiments.localisation.asking import ask, judge, summary
    from experiments.localisation.poses import poses_of
    from services.launcher.client.experimenter import Experimenter
    from services.launcher.client.failure import ExperimentError
    from services.launcher.client.maps import token_header
    from services.launcher.client.stack import StackChoice, open_stack
    from services.launcher.evaluation.truth_file import load_truth, truth_path
    from services.launcher.terminal.output import print_rows, write_json
    from simulator.world.freespace import free_space
    from simulator.world.world_file import load_world

    truth = load_truth(truth_path(data_dir, map_name))
    if truth is None:
        raise ExperimentError(f"no map {map_name!r} explored in {data_dir}: run 'topnav explore' there first")
    space = free_space(load_world(world))
    rng = np.random.default_rng(seed)
    poses = poses_of(space.random_pose, truth.poses.values(), pictures, rng, mapped=not unmapped)
    choice = StackChoice(data_dir, world, seed, lockstep=True, timeout_s=timeout_s)
    with open_stack(choice) as stack:
        if stack.gateway_url is None:
            raise ExperimentError("that stack tells no address of its gateway: give its folder (--data-dir)")
        experimenter = Experimenter(stack.bus, stack.robot)
        with httpx.Client(base_url=stack.gateway_url, headers=token_header(), trust_env=False) as http:
            rows = [
                judge(ask(http, stack.robot, map_name, experimenter.look(pose)), pose, truth.poses)
                for pose in poses
            ]
    told = {"world": world, "map": map_name, "seed": seed, "unmapped": unmapped, "summary": summary(rows)}
    write_json(json_file, {**told, "pictures": rows})
    print_rows("pictures", rows)
    print_rows("summary", [summary(rows)])
    return len(rows)
