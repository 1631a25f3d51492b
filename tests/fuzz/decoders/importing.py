"""Worlds of others: SDF files and COLLADA meshes."""

from pathlib import Path

from simulator.importing.entities import WorldImportError
from simulator.importing.meshes.mesh_files import MeshFiles
from simulator.importing.meshes.pictures import Pictures
from simulator.importing.sdf.resources import Resources
from simulator.importing.sdf.world import read_sdf
from tests.fuzz.decoder import Decoder

ROOT = Path(__file__).resolve().parents[3]
EXAMPLE = ROOT / "deploy/examples/gazebo"
SDF_TOKENS = (
    b"<pose>", b"</pose>", b"<include>", b"<uri>", b"model://table", b"<model name='a'>", b"</model>",
    b"<link>",
    b"<geometry>", b"<mesh>", b"<box><size>", b"<plane>", b"<state>", b"relative_to='a'", b"<!ENTITY", b"&a;",
    b"<frame name='a'>", b"1e999", b"nan", b"<light type='point'>", b"<submesh><name>",
    b"<material><script><name>Gazebo/Wood",
)  # fmt: skip
DAE_TOKENS = (
    b"<p>", b"</p>", b'count="9"', b"<vcount>", b"<polylist", b"<matrix>", b'<instance_node url="#a"/>',
    b"<!--",
    b"<float_array", b'stride="0"', b'offset="7"', b'<transparent opaque="RGB_ZERO">', b"#p", b"1e999",
    b'<unit meter="nan"/>',
)  # fmt: skip


def decoders(scratch: Path) -> list[Decoder]:
    """World files with their includes, and meshes."""
    world, mesh = scratch / "w.world", scratch / "m.dae"
    resources = Resources(EXAMPLE / "two_rooms.world")

    def sdf(data: bytes) -> None:
        world.write_bytes(data)
        scene, missing = read_sdf(world, resources)
        assert all(len(body.seen) + len(body.felt) for one in scene.entities for body in one.bodies), missing

    def dae(data: bytes) -> None:
        mesh.write_bytes(data)
        for surface in MeshFiles(Pictures()).read(mesh):
            assert surface.triangles.shape[1] == 3

    worlds = tuple((EXAMPLE / name).read_bytes() for name in ("two_rooms.world", "models/chair/model.sdf"))
    meshes = ((EXAMPLE / "models/table/meshes/table.dae").read_bytes(),)
    return [
        Decoder("importing/sdf", sdf, (WorldImportError,), worlds, SDF_TOKENS, None, cpu_s=3.0),
        Decoder("importing/dae", dae, (WorldImportError,), meshes, DAE_TOKENS, None, cpu_s=3.0),
    ]
