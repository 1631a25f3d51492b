"""Parts by their extents: what furniture, buildings and bodies are put together from. Pure."""

from dataclasses import replace

from simulator.scene.parts import Material, Part, Span, Vec3
from simulator.scene.prisms import Prism


def around(middle: float, half: float) -> Span:
    """The interval that reaches so far to both sides of its middle."""
    return middle - half, middle + half


def box(x: Span, y: Span, z: Span, material: Material, **options: object) -> Part:
    """A box given by its extents along the axes."""
    centre = ((x[0] + x[1]) / 2, (y[0] + y[1]) / 2, (z[0] + z[1]) / 2)
    size = (abs(x[1] - x[0]), abs(y[1] - y[0]), abs(z[1] - z[0]))
    return replace(Part("box", centre, size, material), **options)  # type: ignore[arg-type]


def detail(x: Span, y: Span, z: Span, material: Material, **options: object) -> Part:
    """A box that is only seen."""
    return box(x, y, z, material, solid=False, **options)


def label(x: Span, y: Span, z: Span, material: Material, **options: object) -> Part:
    """A box that is only seen and shows one whole picture on each side."""
    return box(x, y, z, material, **{"solid": False, "tile_m": None, **options})


def ball(centre: Vec3, size: Vec3, material: Material, **options: object) -> Part:
    """An ellipsoid that is only seen."""
    return replace(Part("ellipsoid", centre, size, material, solid=False), **options)  # type: ignore[arg-type]


def rounded(centre: Vec3, size: Vec3, material: Material, **options: object) -> Part:
    """A box with round edges."""
    return replace(Part("cushion", centre, size, material), **options)  # type: ignore[arg-type]


def table_legs(x: Span, y: Span, z: Span, material: Material) -> list[Part]:
    """Four boxes, one in each quarter, at the same distances from the middle."""
    return [
        box((sx * x[0], sx * x[1]), (sy * y[0], sy * y[1]), z, material) for sx in (-1, 1) for sy in (-1, 1)
    ]


def post(x: float, y: float, z: Span, radius: float, material: Material, **options: object) -> Part:
    """An upright cylinder."""
    part = Part("cylinder", (x, y, (z[0] + z[1]) / 2), (2 * radius, 2 * radius, z[1] - z[0]), material)
    return replace(part, **options)  # type: ignore[arg-type]


def hull_part(prism: Prism, look: Material) -> Part:
    """A prism as a part; `look` is never seen, and had better be one that the world has."""
    low, high = prism.outline_m.min(axis=0), prism.outline_m.max(axis=0)
    middle = (low + high) / 2
    corners = tuple((round(float(x), 5), round(float(y), 5)) for x, y in prism.outline_m - middle)
    return Part(
        "hull", (float(middle[0]), float(middle[1]), (prism.low_m + prism.high_m) / 2),
        (float(high[0] - low[0]), float(high[1] - low[1]), prism.high_m - prism.low_m),
        look, casts_shadow=False, outline_m=corners,
    )  # fmt: skip
