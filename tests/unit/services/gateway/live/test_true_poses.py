"""True positions of a map's places, for the debug view."""

from services.gateway.live.true_poses import TruePoses
from shared.messages.maps import Node
from shared.messages.simulation import Pose, Truth


def truth(stamp_ns: int, x_m: float) -> Truth:
    return Truth(stamp_ns=stamp_ns, robot="r1", world="apartment", pose=Pose(x_m=x_m, y_m=2.0, yaw_rad=0.5))


def test_a_place_is_where_its_frame_was_taken() -> None:
    poses = TruePoses()
    for stamp in (10, 20, 30):
        poses.take(truth(stamp, stamp / 10))
    nodes = [Node(node_id=0, stamp_ns=20), Node(node_id=1, stamp_ns=99)]
    assert poses.of_nodes(nodes) == {0: (2.0, 2.0, 0.5)}


def test_the_oldest_frames_are_forgotten() -> None:
    poses = TruePoses(kept=2)
    for stamp in (10, 20, 30):
        poses.take(truth(stamp, 0.0))
    assert set(poses.of_nodes([Node(node_id=n, stamp_ns=10 * n) for n in (1, 2, 3)])) == {2, 3}
