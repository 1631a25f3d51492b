"""Writes the models of the example worlds: python deploy/examples/worlds/make_models.py FOLDER.

The models are our own work: their shapes are below, and their pictures are drawn by the simulator's textures.
"""

import io
import sys
from pathlib import Path

import numpy as np
import trimesh
from PIL import Image
from trimesh.visual import TextureVisuals
from trimesh.visual.material import PBRMaterial

from simulator.textures.catalogue import draw

Span = tuple[float, float]
FACES = np.array([(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)])


def picture(kind: str, colour: tuple[int, int, int], seed: int, side_px: int = 256) -> Image.Image:
    """Draw a texture and keep it as a small JPEG file in memory."""
    small = Image.fromarray(draw(kind, colour, seed)).resize((side_px, side_px), Image.Resampling.LANCZOS)
    file = io.BytesIO()
    small.save(file, "JPEG", quality=80)
    file.seek(0)
    return Image.open(file)


def boxes(spans: list[tuple[Span, Span, Span]], tile_m: float = 0.7) -> trimesh.Trimesh:
    """Boxes (x, y up, z front) with texture coordinates along their faces."""
    points, uvs = [], []
    for x, y, z in spans:
        corners = np.array([(a, b, c) for a in x for b in y for c in z])
        for face in corners[FACES]:
            normal = int(np.argmin(np.ptp(face, axis=0)))
            across, up = [k for k in (0, 2, 1) if k != normal]
            points.append(face)
            uvs.append(face[:, [across, up]] / tile_m)
    quads = np.arange(4 * len(points)).reshape(-1, 4)
    triangles = np.concatenate([quads[:, [0, 1, 2]], quads[:, [0, 2, 3]]])
    mesh = trimesh.Trimesh(np.concatenate(points), triangles, process=False)
    mesh.visual = TextureVisuals(uv=np.concatenate(uvs))
    return mesh


def lathe(profile: list[tuple[float, float]], sides: int = 20) -> trimesh.Trimesh:
    """A profile of (radius, height) turned round the y axis."""
    angles = np.linspace(0, 2 * np.pi, sides, endpoint=False)
    rings = [np.stack([r * np.cos(angles), np.full(sides, h), -r * np.sin(angles)], -1) for r, h in profile]
    k = np.arange(sides)
    quads = [
        np.stack([row * sides + k, row * sides + (k + 1) % sides,
                  (row + 1) * sides + (k + 1) % sides, (row + 1) * sides + k], -1)
        for row in range(len(profile) - 1)
    ]  # fmt: skip
    all_quads = np.concatenate(quads)
    triangles = np.concatenate([all_quads[:, [0, 1, 2]], all_quads[:, [0, 2, 3]]])
    return trimesh.Trimesh(np.concatenate(rings), triangles, process=False)


def save_scene(path: Path, parts: list[tuple[trimesh.Trimesh, PBRMaterial]]) -> None:
    """Write meshes with their materials as one .glb."""
    scene = trimesh.Scene()
    for mesh, material in parts:
        uv = mesh.visual.uv if isinstance(mesh.visual, TextureVisuals) else None
        mesh.visual = TextureVisuals(uv=uv, material=material)
        scene.add_geometry(mesh)
    path.write_bytes(scene.export(file_type="glb"))


def armchair(path: Path) -> None:
    """Upholstered chair, textured, on plain wooden feet."""
    cloth = [
        ((-0.4, 0.4), (0.16, 0.44), (-0.36, 0.38)),
        ((-0.4, 0.4), (0.44, 0.95), (-0.4, -0.22)),
        ((-0.44, -0.28), (0.16, 0.62), (-0.4, 0.36)),
        ((0.28, 0.44), (0.16, 0.62), (-0.4, 0.36)),
    ]
    feet = [
        ((x - 0.03, x + 0.03), (0.0, 0.16), (z - 0.03, z + 0.03)) for x in (-0.36, 0.36) for z in (-0.32, 0.3)
    ]
    save_scene(path, [
        (boxes(cloth, 0.6), PBRMaterial(baseColorTexture=picture("pattern_cloth", (150, 74, 60), 8))),
        (boxes(feet), PBRMaterial(baseColorFactor=[70, 40, 22, 255])),
    ])  # fmt: skip


def cart(path: Path) -> None:
    """Market cart: a wooden tray on legs with baskets in it, two textures."""
    tray = [
        ((-0.75, 0.75), (0.5, 0.56), (-0.45, 0.45)),
        ((-0.75, 0.75), (0.56, 0.8), (-0.45, -0.4)),
        ((-0.75, 0.75), (0.56, 0.8), (0.4, 0.45)),
        ((-0.75, -0.7), (0.56, 0.8), (-0.4, 0.4)),
        ((0.7, 0.75), (0.56, 0.8), (-0.4, 0.4)),
        *[((x - 0.04, x + 0.04), (0.0, 0.5), (z - 0.04, z + 0.04)) for x in (-0.6, 0.6) for z in (-0.4, 0.4)],
    ]
    goods = [((-0.6 + 0.42 * k, -0.25 + 0.42 * k), (0.56, 0.86 + 0.07 * k), (-0.3, 0.25)) for k in range(3)]
    save_scene(path, [
        (boxes(tray, 0.8), PBRMaterial(baseColorTexture=picture("wood", (150, 104, 62), 3))),
        (boxes(goods, 0.4), PBRMaterial(baseColorTexture=picture("wicker", (196, 150, 84), 5))),
    ])  # fmt: skip


def vase(path: Path) -> None:
    """Tall vase whose colours are at its vertices."""
    profile = [(0.001, 0.0), (0.16, 0.0), (0.19, 0.12), (0.24, 0.34), (0.22, 0.55), (0.13, 0.74), (0.1, 0.86),
               (0.15, 0.96), (0.13, 0.96), (0.001, 0.9)]  # fmt: skip
    mesh = lathe(profile, 24)
    rng = np.random.default_rng(4)
    bands = rng.integers(20, 230, (len(profile), 3)).astype(np.uint8)
    colours = np.repeat(bands, 24, axis=0)
    colours[::3] = (240, 228, 196)
    mesh.visual.vertex_colors = np.concatenate([colours, np.full((len(colours), 1), 255, np.uint8)], axis=1)
    path.write_bytes(trimesh.Scene([mesh]).export(file_type="glb"))


def bookcase(path: Path) -> None:
    """Case of plain boards with a picture of books in it: an OBJ file with its MTL and JPEG."""
    boards = [((-0.5, 0.5), (y, y + 0.03), (-0.15, 0.15)) for y in (0.0, 0.45, 0.9, 1.35, 1.77)]
    boards += [((-0.5, -0.47), (0.0, 1.8), (-0.15, 0.15)), ((0.47, 0.5), (0.0, 1.8), (-0.15, 0.15)),
               ((-0.5, 0.5), (0.0, 1.8), (-0.15, -0.13))]  # fmt: skip
    books = [((-0.46, 0.46), (y + 0.03, y + 0.33), (-0.12, 0.1)) for y in (0.0, 0.45, 0.9, 1.35)]
    lines = [f"mtllib {path.stem}.mtl"]
    count = 0
    for name, mesh in (("boards", boxes(boards)), ("books", boxes(books, 0.92))):
        lines += [f"v {x:.4f} {y:.4f} {z:.4f}" for x, y, z in mesh.vertices]
        lines += [f"vt {u:.4f} {v:.4f}" for u, v in mesh.visual.uv]
        lines += [f"o {name}", f"usemtl {name}"]
        lines += ["f " + " ".join(f"{k + 1 + count}/{k + 1 + count}" for k in face) for face in mesh.faces]
        count += len(mesh.vertices)
    path.write_text("\n".join(lines) + "\n", encoding="utf-8")
    picture("books", (120, 80, 60), 11, 384).save(path.with_suffix(".jpg"), quality=80)
    path.with_suffix(".mtl").write_text(
        f"newmtl boards\nKd 0.62 0.47 0.30\nnewmtl books\nmap_Kd {path.stem}.jpg\n", encoding="utf-8"
    )


def basin(path: Path) -> None:
    """Stone basin with a bowl, vertex colours like worn stone."""
    profile = [(0.001, 0.0), (0.7, 0.0), (0.74, 0.35), (0.66, 0.42), (0.6, 0.3), (0.14, 0.26), (0.12, 0.8),
               (0.36, 0.95), (0.34, 0.99), (0.001, 0.93)]  # fmt: skip
    mesh = lathe(profile, 28)
    rng = np.random.default_rng(9)
    tone = rng.integers(90, 215, (len(mesh.vertices), 1))
    colours = np.clip(tone + np.array([[6, 2, -8]]), 0, 255).astype(np.uint8)
    mesh.visual.vertex_colors = np.concatenate([colours, np.full((len(colours), 1), 255, np.uint8)], axis=1)
    path.write_bytes(trimesh.Scene([mesh]).export(file_type="glb"))


def main() -> None:
    """Write all models into the folder given."""
    folder = Path(sys.argv[1])
    folder.mkdir(parents=True, exist_ok=True)
    armchair(folder / "armchair.glb")
    cart(folder / "cart.glb")
    vase(folder / "vase.glb")
    bookcase(folder / "bookcase.obj")
    basin(folder / "basin.glb")


if __name__ == "__main__":
    main()
