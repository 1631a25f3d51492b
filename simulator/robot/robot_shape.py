"""How the robot looks. The same parts, tinted, make the second robot (the hider). Pure.

Nothing stands above the camera, and the body stays below latitude -65 degrees of its own picture: a part
of radius r reaches up to camera height - r tan(65 deg) at most.
"""

from dataclasses import replace

from simulator.robot.undercarriage import undercarriage_of
from simulator.scene.parts import Material, Part, Rgb
from simulator.scene.shapes import box, post
from simulator.settings import RobotSettings

SEEKER: Rgb = (214, 216, 218)
HIDER: Rgb = (214, 116, 40)


def chassis_parts(robot: RobotSettings, colour: Rgb) -> tuple[Part, ...]:
    """Body, deck and mast in the robot frame (origin on the floor under its centre, x forward)."""
    shell, dark = Material("lacquer", colour, 31), Material("lacquer", (52, 54, 58), 32)
    steel, accent = Material("metal", (150, 152, 156), 33), Material("lacquer", (36, 108, 160), 34)
    top, radius = robot.body_top_m, robot.body_radius_m
    parts = [
        post(0.0, 0.0, (0.1, top - 0.025), radius - 0.012, shell, tile_m=0.4),
        post(0.0, 0.0, (top - 0.025, top), radius, dark, tile_m=0.4),
        box((0.08, 0.2), (-0.03, 0.03), (top, top + 0.006), accent),  # marks the front
        box((-0.17, -0.09), (-0.05, 0.05), (top, top + 0.02), steel),
        post(0.0, 0.0, (top, robot.mast_top_m - 0.06), robot.mast_radius_m, steel),
        post(
            0.0, 0.0, (robot.mast_top_m - 0.06, robot.mast_top_m), robot.mast_radius_m * 1.1, dark, taper=0.8
        ),
    ]
    parts.extend(
        post(0.16 * sx, 0.13 * sy, (top, top + 0.012), 0.022, dark) for sx in (-1, 1) for sy in (-1, 1)
    )
    return tuple(parts)


def leg_parts(robot: RobotSettings, wheel_m: float) -> tuple[Part, ...]:
    """A leg: fork from the steer servo down to the axle; origin at the axle, wheel rolls along x."""
    steel = Material("metal", (150, 152, 156), 33)
    rise = robot.body_top_m - 0.06 - wheel_m
    arms = tuple(box((-0.012, 0.012), (s * 0.022, s * 0.03), (-0.01, rise), steel) for s in (-1, 1))
    return (*arms, box((-0.02, 0.02), (-0.03, 0.03), (rise, rise + 0.02), steel))


def wheel_parts(radius_m: float) -> tuple[Part, ...]:
    """A wheel with spokes, axle along y, origin at its centre."""
    tyre, hub = Material("lacquer", (34, 34, 36), 35), Material("metal", (196, 196, 200), 36)
    r = radius_m
    return (
        Part("cylinder", (0.0, 0.0, 0.0), (2 * r, 2 * r, 0.034), tyre, roll_rad=1.5707963267948966),
        Part("cylinder", (0.0, 0.0, 0.0), (1.3 * r, 1.3 * r, 0.038), hub, roll_rad=1.5707963267948966),
        box((-0.008, 0.008), (-0.021, 0.021), (-0.6 * r, 0.6 * r), tyre),
        box((-0.6 * r, 0.6 * r), (-0.021, 0.021), (-0.008, 0.008), tyre),
    )


def link_parts(robot: RobotSettings, colour: Rgb) -> dict[str, tuple[Part, ...]]:
    """Parts of each link of the articulation by its name; legs only where wheels steer."""
    links = {"chassis": chassis_parts(robot, colour)}
    for k, mount in enumerate(undercarriage_of(robot.base).mounts):
        if mount.steered:
            links[f"leg{k}"] = leg_parts(robot, mount.radius_m)
        links[f"wheel{k}"] = wheel_parts(mount.radius_m)
    return links


def whole_robot(robot: RobotSettings, colour: Rgb) -> tuple[Part, ...]:
    """All parts in one rigid body, wheels straight: for the robot that only stands there."""
    parts = list(chassis_parts(robot, colour))
    for mount in undercarriage_of(robot.base).mounts:
        leg = leg_parts(robot, mount.radius_m) if mount.steered else ()
        for part in (*leg, *wheel_parts(mount.radius_m)):
            cx, cy, cz = part.centre_m
            parts.append(replace(part, centre_m=(cx + mount.x_m, cy + mount.y_m, cz + mount.radius_m)))
    return tuple(parts)
