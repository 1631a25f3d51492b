"""What lies beyond the world: a dome of sky with clouds, and open land up to the horizon. Pure."""

import hashlib
import math

import numpy as np
import numpy.typing as npt

from simulator.scene.lighting import Sunlight
from simulator.scene.meshes import Mesh, grid_triangles
from simulator.scene.parts import Geometry, Material, Part, Picture
from simulator.textures.catalogue import draw
from simulator.textures.noise import Image, spectral_noise
from simulator.world.world_file import Sky, WorldFile

RADIUS_M = 220.0  # beyond any world (world_file.MOST_SPAN_M, from its middle) and its corners
LAND_LOW_M = -0.12  # below floors and their slabs
LOWEST_RAD = math.radians(-4.0)  # the dome ends below the horizon, where land hides its edge
LAND_TILE_M, GREEN = 6.0, (104, 126, 70)  # by eye
SEGMENTS, RINGS = 64, 16  # by eye: the dome looks round
HEIGHT_PX, WIDTH_PX = 512, 2048  # a column is as wide as that of the camera's picture


def backdrop(world: WorldFile) -> list[Part]:
    """Sky and land round a world that has grounds; nothing for one without. They are not lit: they shine."""
    if not world.grounds and world.sky is None:
        return []
    rects = world.rectangles()
    centre = tuple((min(r[axis][0] for r in rects) + max(r[axis][1] for r in rects)) / 2 for axis in (0, 1))
    sky = world.sky or Sky()
    size = (2 * RADIUS_M, 2 * RADIUS_M, 2 * RADIUS_M)
    return [
        _shining(_dome(), _picture(sky_picture(sky)), (*centre, 0.0), size),
        _shining(_land(), _picture(draw("grass", GREEN, sky.seed)), (*centre, LAND_LOW_M), size),
    ]


def sunlight(world: WorldFile) -> Sunlight | None:
    """The world's sun as parallel light."""
    if world.sun is None:
        return None
    azimuth, elevation = math.radians(world.sun.azimuth_deg), math.radians(world.sun.elevation_deg)
    flat = math.cos(elevation)
    towards = (flat * math.cos(azimuth), flat * math.sin(azimuth), math.sin(elevation))
    return Sunlight(towards, world.sun.power)


def sky_picture(sky: Sky) -> Image:
    """Panorama of the sky: column 0 and the last one meet; row 0 is the zenith, the last just below level."""
    rng = np.random.default_rng([sky.seed, *b"sky"])
    elevation = np.linspace(math.pi / 2, LOWEST_RAD, HEIGHT_PX)[:, None, None]
    share = np.clip(np.sin(elevation), 0.0, 1.0) ** 0.55
    colour = np.array(sky.horizon, float) * (1.0 - share) + np.array(sky.zenith, float) * share
    image = np.broadcast_to(colour, (HEIGHT_PX, WIDTH_PX, 3))
    field = spectral_noise(rng, HEIGHT_PX, WIDTH_PX, 1.55, stretch=2.0)
    edge = np.quantile(field, 1.0 - sky.clouds) if sky.clouds > 0.0 else np.inf
    cover = np.clip((field - edge) / 0.9, 0.0, 1.0)[..., None] ** 0.7
    cover = cover * np.clip(elevation / math.radians(7.0), 0.15, 1.0)
    shade = 250.0 - 46.0 * np.clip(np.roll(field, -9, axis=0) - edge, 0.0, 2.0)[..., None] / 2.0
    return np.asarray(np.clip(image * (1.0 - cover) + shade * cover, 0, 255), np.uint8)


def _dome() -> Mesh:
    azimuth = np.linspace(0.0, math.tau, SEGMENTS + 1)
    elevation = np.linspace(math.pi / 2, LOWEST_RAD, RINGS + 1)
    around, up = np.meshgrid(azimuth, elevation)
    unit = np.stack([np.cos(up) * np.cos(around), np.cos(up) * np.sin(around), np.sin(up)], axis=-1)
    rows = (math.pi / 2 - up) / (math.pi / 2 - LOWEST_RAD)
    uv = np.stack([1.0 - around / math.tau, rows], axis=-1)
    return _sheet(unit * RADIUS_M, -unit, uv)


def _land() -> Mesh:
    """A disc that ends where the dome does."""
    azimuth = np.linspace(0.0, math.tau, SEGMENTS + 1)
    radius = RADIUS_M * np.linspace(1.0, 0.0, RINGS + 1) ** 2
    around, out = np.meshgrid(azimuth, radius)
    flat = np.stack([out * np.cos(around), out * np.sin(around), np.zeros_like(out)], axis=-1)
    up = np.broadcast_to(np.array([0.0, 0.0, 1.0]), flat.shape)
    return _sheet(flat, up, flat[..., :2] / LAND_TILE_M)


def _sheet(
    points: npt.NDArray[np.float64], normals: npt.NDArray[np.float64], uv: npt.NDArray[np.float64]
) -> Mesh:
    """Triangles of a grid of points, turned so that their fronts face along the normals."""
    rows, columns = points.shape[:2]
    triangles = grid_triangles(rows, columns)
    flat, facing = points.reshape(-1, 3), normals.reshape(-1, 3)
    sides = np.cross(
        flat[triangles[:, 1]] - flat[triangles[:, 0]], flat[triangles[:, 2]] - flat[triangles[:, 0]]
    )
    wrong = (sides * facing[triangles[:, 0]]).sum(axis=1) < 0.0
    triangles[wrong] = triangles[wrong][:, ::-1]
    return Mesh(
        flat.astype(np.float32), facing.astype(np.float32), uv.reshape(-1, 2).astype(np.float32), triangles
    )


def _picture(pixels: Image) -> Picture:
    return Picture(hashlib.sha256(pixels.tobytes()).hexdigest(), pixels)


def _shining(
    mesh: Mesh, picture: Picture, centre: tuple[float, ...], size: tuple[float, float, float]
) -> Part:
    geometry = Geometry(hashlib.sha256(mesh.vertices.tobytes()).hexdigest(), mesh)
    material = Material("glow", glow=1.0, picture=picture)
    place = (centre[0], centre[1], centre[2])
    return Part("mesh", place, size, material, solid=False, casts_shadow=False, geometry=geometry)
