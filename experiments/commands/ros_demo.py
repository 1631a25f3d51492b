"""`topnav ros-demo`: the demo with a robot that only ROS 2 reaches."""

from pathlib import Path
from typing import Annotated

import typer

from services.launcher.terminal import options

app = typer.Typer()


@app.command("ros-demo")
def ros_demo(
    python: Annotated[
        Path, typer.Option(exists=True, help="An interpreter that has rclpy; deploy/setup/ros.sh makes one.")
    ] = Path(".venv-ros/bin/python"),
    domain: Annotated[int, typer.Option(min=0, max=232, help="ROS_DOMAIN_ID of the robot.")] = 77,
    world: options.World = "apartment",
    seed: options.Seed = 1,
    explore_steps: Annotated[int, typer.Option(min=1, help="Go seeking after so many at the latest.")] = 5000,
    runs: Annotated[Path, typer.Option(help="The report goes to a new folder in here.")] = options.RUNS_DIR,
    timeout_s: options.TimeoutS = options.START_TIMEOUT_S,
) -> None:
    """Explore and find a hidden robot's picture with a robot in ROS 2: rclpy, Fast DDS, real time.

    The simulator is a node that publishes CompressedImage, LaserScan, Odometry and Imu, and hears
    TwistStamped; topnav reaches it by services/ros alone, and the guard stands before its base.
    """
    from experiments.ros_robot.robot import RosRobot, running_stack
    from services.launcher.client.stack import StackChoice
    from services.launcher.evaluation.demo import Scene, play, require_found
    from services.launcher.terminal.output import new_run_folder, wide_console
    from simulator.world.freespace import free_space
    from simulator.world.world_file import load_world

    console, file = wide_console(), load_world(world)
    scene = Scene(file, free_space(file), seed, new_run_folder(runs))
    robot = RosRobot(scene.folder / "robot", world, seed, domain, python)
    choice = StackChoice(scene.folder / "data", seed=seed, timeout_s=timeout_s)
    console.print(f"starting a robot in ROS, domain {domain}, logs in {robot.folder}", highlight=False)
    with running_stack(robot, choice) as stack:
        found = play(console, stack, scene, choice.data_dir, explore_steps)
    require_found(found)
