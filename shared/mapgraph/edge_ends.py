"""The edge between two nodes from what one of them saw of the other. Pure."""

import math


def edge_between(
    first: int, second: int, heading_rad: float | None, yaw_rad: float | None
) -> dict[str, int | float | None]:
    """Ends and headings of the edge between `first` (the current frame) and `second`, with a < b.

    Args:
        first: id of the current frame's node.
        second: id of the other node.
        heading_rad: direction first -> second in first's camera frame; None when unknown.
        yaw_rad: rotation from first's camera to second's; None when unknown.
    """
    back_rad = None
    if heading_rad is not None and yaw_rad is not None:
        back_rad = math.remainder(heading_rad + math.pi - yaw_rad, math.tau)
    if first < second:
        return {
            "a": first,
            "b": second,
            "heading_ab_rad": heading_rad,
            "heading_ba_rad": back_rad,
            "yaw_ab_rad": yaw_rad,
        }
    turned_rad = -yaw_rad if yaw_rad is not None else None
    return {
        "a": second,
        "b": first,
        "heading_ab_rad": back_rad,
        "heading_ba_rad": heading_rad,
        "yaw_ab_rad": turned_rad,
    }
