"""What of a model stops the robot: nodes that touch, walls with rooms between them, collision files."""

import numpy as np
import pytest

from simulator.assets.hollow import is_hollow
from simulator.assets.shell import shell_of
from simulator.assets.solids import needs_sheets, prisms
from simulator.scene.meshes import Mesh
from simulator.scene.parts import Material
from simulator.scene.shapes import hull_part
from simulator.world.contents import placed
from simulator.world.footprints import clearance_m, footprints
from tests.unit.simulator.assets.conftest import obj_text
from tests.unit.simulator.scene.test_prisms import boxes

WALL = 0.2


def mesh_of(*spans):
    vertices, triangles = boxes(*spans)
    none = np.zeros((len(vertices), 3), np.float32)
    return Mesh(vertices.astype(np.float32), none, none[:, :2], triangles.astype(np.uint32))


def ring(width=6.0, height=2.5):
    """Four walls round a room, touching at the corners."""
    return mesh_of(
        ((0, 0, 0), (width, WALL, height)),
        ((0, width - WALL, 0), (width, width, height)),
        ((0, WALL, 0), (WALL, width - WALL, height)),
        ((width - WALL, WALL, 0), (width, width - WALL, height)),
    )


def gaps(found, *points, band=(0.02, 0.79)):
    """Distances from points to what stops the robot."""
    parts = tuple(hull_part(prism, Material("plaster")) for prism in found)
    return clearance_m(np.array(points, float), footprints(parts, *band))


def test_hull_of_walls_fills_the_room_and_sheets_leave_it_free():
    assert gaps(prisms([ring()], "convex"), (3, 3))[0] == 0.0
    assert needs_sheets([ring()])
    inside, outside, wall = gaps(prisms([ring()], "concave"), (3, 3), (-1, 3), (0.1, 3))
    assert inside == pytest.approx(3 - WALL, abs=0.06)
    assert outside == pytest.approx(1.0, abs=0.06)
    assert wall < 0.12


def test_doorway_is_as_wide_as_in_the_mesh_and_its_lintel_is_above_it():
    wall = mesh_of(((0, 0, 0), (2, 0.1, 2.5)), ((2.9, 0, 0), (5, 0.1, 2.5)), ((2, 0, 2.1), (2.9, 0.1, 2.5)))
    rest = mesh_of(((0, 0.1, 0), (0.1, 4, 2.5)), ((4.9, 0.1, 0), (5, 4, 2.5)), ((0, 4, 0), (5, 4.1, 2.5)))
    vertices = np.concatenate([wall.vertices, rest.vertices])
    triangles = np.concatenate([wall.triangles, rest.triangles + np.uint32(len(wall.vertices))])
    found = shell_of(vertices.astype(float), triangles)
    assert gaps(found, (2.45, 0.05))[0] == pytest.approx(0.45, abs=0.06)
    assert gaps(found, (2.45, 0.05), band=(2.2, 2.4))[0] < 0.05


@pytest.mark.parametrize("low_m", [0.0, -0.013, -0.04])
def test_carpet_in_a_mesh_of_walls_stops_nobody_and_a_table_in_it_does(low_m):
    carpet, table = ((1, 1, 0), (3, 3, 0.01)), ((4, 4, 0), (5, 5, 0.7))
    sill = ((0, 0.5, low_m), (0.1, 0.6, 0.04))
    whole = mesh_of(*[((0, 0, low_m), (6, WALL, 2)), ((0, 5.8, 0), (6, 6, 2)), carpet, table, sill])
    on_edge, at_table = gaps(shell_of(whole.vertices.astype(float), whole.triangles), (1, 2), (4, 4.5))
    assert on_edge > 0.5
    assert at_table < 0.05


def test_solids_and_small_things_are_not_hollow():
    assert not is_hollow(mesh_of(((0, 0, 0), (3, 2, 1))), 0.0)
    assert not is_hollow(mesh_of(((0, 0, 0), (0.5, 0.1, 1)), ((0, 0.4, 0), (0.5, 0.5, 1))), 0.0)
    assert not is_hollow(ring(), -3.0), "what is out of the robot's reach takes no floor away"
    legs = [((x, y, 0), (x + 0.1, y + 0.1, 0.7)) for x in (0, 1.9) for y in (0, 0.9)]
    assert not is_hollow(mesh_of(((0, 0, 0.7), (2, 1, 0.75)), *legs), 0.0)


def test_nodes_that_touch_have_hulls_of_their_own():
    angle = [mesh_of(((0, 0, 0), (3, 0.2, 1))), mesh_of(((0, 0.2, 0), (0.2, 3, 1)))]
    assert gaps(prisms(angle, "convex"), (1.5, 1.5))[0] == pytest.approx(1.3, abs=0.02)
    one = mesh_of(((0, 0, 0), (3, 0.2, 1)), ((0, 0.2, 0), (0.2, 3, 1)))
    assert gaps(prisms([one], "convex"), (1.0, 1.0))[0] == 0.0


def test_faces_that_are_there_twice_count_once():
    assert len(prisms([ring(), ring()], "concave")) == len(prisms([ring()], "concave"))


def test_collision_file_is_felt_and_the_model_is_seen(show, box_obj, tmp_path):
    (tmp_path / "slim.obj").write_text(obj_text(_slim()), encoding="utf-8")
    world = show(file=box_obj, up="z", centred=False, collision={"file": "slim.obj", "outline": "box"})
    parts = _parts(world)
    hulls = [part for part in parts if part.solid]
    assert len(hulls) == 1
    assert hulls[0].size_m == pytest.approx((0.2, 0.2, 3.0), abs=0.01)
    assert next(part for part in parts if not part.solid).size_m == pytest.approx((2, 1, 4))


def _slim():
    return np.array([(x, y, z) for x in (0.9, 1.1) for y in (0.4, 0.6) for z in (0.0, 3.0)])


def _parts(world):
    return placed(world.furniture[0]).parts


@pytest.mark.parametrize(
    ("options", "size"),
    [({"roll_deg": 90.0}, (2, 4, 1)), ({"pitch_deg": 90.0}, (4, 1, 2)), ({"pitch_deg": 180.0}, (2, 1, 4))],
)
def test_roll_and_pitch_turn_what_is_seen_and_felt(show, box_obj, options, size):
    for part in _parts(show(file=box_obj, up="z", **options)):
        assert part.size_m == pytest.approx(size, abs=0.02)


def test_positive_pitch_lowers_the_front(show, box_obj):
    tilted = next(part for part in _parts(show(file=box_obj, up="z", centred=False, pitch_deg=30.0)))
    points = tilted.geometry.mesh.vertices + np.array(tilted.centre_m)
    assert points[np.argmax(points[:, 0]), 2] > points[np.argmin(points[:, 0]), 2]
    assert points[:, 2].min() < -0.9


@pytest.mark.parametrize(
    "wrong", [{"file": "gone.obj"}, {"outline": "box"}, {"file": "box.obj", "outline": "x"}, "hull"]
)
def test_wrong_collision_is_named(show, box_obj, wrong):
    with pytest.raises(ValueError, match="collision"):
        show(file=box_obj, collision=wrong)
