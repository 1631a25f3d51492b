"""`topnav bench loop`: how long each stage of the loop takes over a real mission."""

import tempfile
from pathlib import Path
from typing import Annotated

import typer

from experiments.bench.latency import FrameTimes, latency
from experiments.bench.listener import Listener
from experiments.bench.machine import machine
from experiments.bench.processor_time import ServiceTimes
from experiments.bench.stages import stage_durations_ms, table
from services.launcher.client.failure import ExperimentError, one_line_errors
from services.launcher.client.stack import StackChoice, open_stack
from services.launcher.evaluation.exploration import explore
from services.launcher.terminal import options
from services.launcher.terminal.output import rounded, write_json
from services.launcher.terminal.progress import mission_progress
from services.launcher.terminal.tables import print_rows, wide_console

MAP = "bench"
RealTime = Annotated[
    bool, typer.Option("--real-time", help="Without lockstep: frames come at their own rate, as on a robot.")
]


def main(
    world: options.World = "apartment",
    steps: Annotated[int, typer.Option(min=20, help="Length of the mission.")] = 300,
    seed: options.Seed = 1,
    json_file: options.JsonFile = None,
    pipeline: options.PipelineName = None,
    real_time: RealTime = False,
) -> None:
    """Time the stages of the control loop while a robot explores; uses a stack and a map of its own."""
    with tempfile.TemporaryDirectory(prefix="topnav-bench-") as folder, one_line_errors():
        choice = StackChoice(Path(folder), world, seed, lockstep=not real_time, pipeline=pipeline)
        with (
            open_stack(choice) as stack,
            Listener(stack.address, stack.robot) as listener,
            mission_progress(wide_console(stderr=True), "timing") as watch,
            FrameTimes(stack) as times,
        ):
            processors = ServiceTimes(stack.launcher)
            result = explore(stack, world, MAP, seed, steps, watch=watch)
            cpu = processors.figures(result.run.status.step)
    if result.run.status.step < min(20, steps):
        raise ExperimentError(
            f"the mission ended after {result.run.status.step} steps: {result.run.status.reason}"
        )
    waits = latency(times.frames, times.commands)
    durations = stage_durations_ms(listener.arrivals)
    stages = table(durations)
    rate = rounded(result.run.steps_per_s, 2)
    if json_file is not None:
        counts = {stage: len(d) for stage, d in durations.items()}
        figures = {"steps_per_s": rate, "stages": stages, "machine": machine(), "samples": counts}
        figures |= {"frame_to_command": waits, "lockstep": not real_time, "cpu": cpu}
        write_json(json_file, {**figures, "steps": result.run.status.step, "nodes": result.run.status.nodes})
    print_rows(f"{rate} steps/s", [{"stage": name, **row} for name, row in stages.items()])
    print_rows("frame to command", [waits])
    print_rows("processor time", [{"service": name, **row} for name, row in cpu.items()])
