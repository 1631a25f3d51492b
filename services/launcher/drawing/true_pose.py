"""The true pose in Foxglove.

It is here and not in the recorder because services are blind to the true pose. Needs the extra `foxglove`.
"""

from collections.abc import Sequence

from foxglove.messages import FrameTransform, PoseInFrame, Vector3

from services.recorder.foxglove.drawings import Drawing, floor_pose, rotation, timestamp
from shared.messages.base import Message
from shared.messages.simulation import Truth


def draw_true_pose(message: Message, arrived_ns: int) -> Sequence[Drawing]:
    """Where the simulator has the robot and the hidden one, in a world named "simulation only"."""
    if not isinstance(message, Truth):
        return []
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
