"""`topnav bench`: timings."""

import tempfile
from pathlib import Path
from typing import Annotated

import typer

from services.launcher.terminal import options

app = typer.Typer(name="bench", no_args_is_help=True, help="Time the stages of the control loop.")

MAP = "bench"
LEAST_STEPS = 20
"""Fewer cycles give no 99th percentile worth telling."""

RealTime = Annotated[
    bool, typer.Option("--real-time", help="Without lockstep: frames come at their own rate, as on a robot.")
]


@app.command()
def loop(
    world: options.World = "apartment",
    steps: Annotated[int, typer.Option(min=LEAST_STEPS, help="Length of the mission.")] = 300,
    seed: options.Seed = 1,
    json_file: options.JsonFile = None,
    pipeline: options.PipelineName = None,
    real_time: RealTime = False,
) -> None:
    """Time the stages of the control loop while a robot explores; uses a stack and a map of its own."""
    from experiments.bench.listener import ENDS, Listener
    from experiments.bench.resources import ServiceTimes, machine
    from experiments.bench.stages import latency, stage_durations_ms, table
    from services.launcher.client.failure import ExperimentError
    from services.launcher.client.stack import StackChoice, open_stack
    from services.launcher.evaluation.exploration import explore
    from services.launcher.terminal.output import print_rows, rounded, wide_console, write_json
    from services.launcher.terminal.progress import mission_progress

    with tempfile.TemporaryDirectory(prefix="topnav-bench-") as folder:
        choice = StackChoice(Path(folder), world, seed, lockstep=not real_time, pipeline=pipeline)
        with (
            open_stack(choice) as stack,
            Listener(stack.address, stack.robot) as stages_heard,
            mission_progress(wide_console(stderr=True), "timing") as watch,
            Listener(stack.address, stack.robot, ENDS) as ends_heard,
        ):
            processors = ServiceTimes(stack.launcher)
            run = explore(stack, world, MAP, seed, steps, watch=watch).run
            cpu = processors.figures(run.status.step)
    if run.status.step < LEAST_STEPS:
        raise ExperimentError(f"the mission ended after {run.status.step} steps: {run.status.reason}")
    waits, durations = latency(ends_heard.arrivals), stage_durations_ms(stages_heard.arrivals)
    stages, rate = table(durations), rounded(run.steps_per_s, 2)
    figures = {
        "steps_per_s": rate,
        "stages": stages,
        "machine": machine(),
        "samples": {stage: len(each) for stage, each in durations.items()},
        "frame_to_command": waits,
        "lockstep": not real_time,
        "cpu": cpu,
        "steps": run.status.step,
        "nodes": run.status.nodes,
    }
    write_json(json_file, figures)
    print_rows(f"{rate} steps/s", [{"stage": name, **row} for name, row in stages.items()])
    print_rows("frame to command", [waits])
    print_rows("processor time", [{"service": name, **row} for name, row in cpu.items()])
