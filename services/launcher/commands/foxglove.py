"""`topnav foxglove`: a recording for Foxglove, which reads no msgpack."""

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from services.launcher.terminal.tables import print_rows
from services.recorder.foxglove.export import export
from shared.messages import Message, Truth

if TYPE_CHECKING:
    from services.recorder.foxglove.drawings import Drawing

app = typer.Typer(add_completion=False, pretty_exceptions_enable=False)


@app.command()
def main(
    file: Annotated[Path, typer.Argument(help="A file of 'topnav record'; a broken one up to the damage.")],
    out: Annotated[Path, typer.Argument(help="MCAP file to write, for Foxglove.")],
) -> None:
    """Convert a recording for Foxglove: pictures, distances, arrows, decisions, and all numbers for plots."""
    done = export(file, out, draw_true_pose)
    rows = [{"channel": name, "messages": count} for name, count in sorted(done.counts.items())]
    print_rows(f"{out}, {out.stat().st_size / 1e6:.1f} MB", rows)
    for key, (count, reason) in done.left_out.items():
        typer.echo(f"left out: {count} of {key} ({reason})")
    if done.problem:
        typer.echo(f"{file} ends early ({done.problem}): what follows is not in {out}")


def draw_true_pose(message: Message, arrived_ns: int) -> "Sequence[Drawing]":
    """Where the simulator has the robot and the hidden one, in a world named "simulation only".

    It is here and not in the recorder because services are blind to the true pose.
    """
    if not isinstance(message, Truth):
        return []
    # Only when called: the command must start, and say what is missing, without the extra `foxglove`.
    from foxglove.messages import FrameTransform, PoseInFrame, Vector3

    from services.recorder.foxglove.drawings import Drawing, floor_pose, rotation, timestamp

    stamp, world, pose = timestamp(message, arrived_ns), f"{message.world} (simulation only)", message.pose
    transform = FrameTransform(
        timestamp=stamp,
        parent_frame_id=world,
        child_frame_id=message.robot,
        translation=Vector3(x=pose.x_m, y=pose.y_m, z=0.0),
        rotation=rotation(pose.yaw_rad),
    )
    drawings = [Drawing("simulation only", transform)]
    if message.hider is not None:
        hider = floor_pose(message.hider.x_m, message.hider.y_m, message.hider.yaw_rad)
        hidden = PoseInFrame(timestamp=stamp, frame_id=world, pose=hider)
        drawings.append(Drawing("simulation only/hider", hidden))
    return drawings
