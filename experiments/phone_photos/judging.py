"""An answer against where the photo was truly taken. Pure."""

import math
from collections.abc import Mapping, Sequence
from typing import Any

from experiments.phone_photos.taking import Shot
from shared.mapgraph.photographs.search import PhotoPlace
from shared.mapgraph.photographs.verdict import PhotoAnswer
from shared.messages.simulation import Pose

RIGHT_M, RIGHT_RAD = 1.0, math.radians(20.0)
"""A place and a direction this near are the right ones."""


def judge(shot: Shot, answer: PhotoAnswer, nodes: Mapping[int, Pose]) -> dict[str, Any]:
    """One row of the report."""
    errors = [error_of(place, shot.pose, nodes) for place in answer.places]
    right = [off_m <= RIGHT_M and off_rad <= RIGHT_RAD for off_m, off_rad in errors]
    found = answer.verdict == "found"
    return {
        "fov_deg": round(math.degrees(shot.fov_rad), 1),
        "fov_known": shot.fov_known,
        "fov_found_deg": None if not answer.places else round(math.degrees(answer.places[0].fov_rad), 1),
        "verdict": answer.verdict,
        "places": len(answer.places),
        "off_m": round(errors[0][0], 2) if errors else None,
        "off_deg": round(math.degrees(errors[0][1]), 1) if errors else None,
        "keypoints": answer.places[0].keypoints if answer.places else 0,
        "score": round(answer.places[0].score, 1) if answer.places else 0.0,
        "right": found and right[0],
        "wrong": found and not right[0],
        "listed": answer.verdict == "ambiguous" and any(right),
    }


def error_of(place: PhotoPlace, pose: Pose, nodes: Mapping[int, Pose]) -> tuple[float, float]:
    """How far a place is from a pose, metres, and by how much it looks elsewhere, radians."""
    node = nodes[place.node]
    cos, sin = math.cos(node.yaw_rad), math.sin(node.yaw_rad)
    x_m = node.x_m + cos * place.x_m - sin * place.y_m
    y_m = node.y_m + sin * place.x_m + cos * place.y_m
    turned_rad = math.remainder(node.yaw_rad + place.yaw_rad - pose.yaw_rad, math.tau)
    return math.hypot(x_m - pose.x_m, y_m - pose.y_m), abs(turned_rad)


def summary(rows: Sequence[Mapping[str, Any]]) -> dict[str, Any]:
    """Counts; the errors are medians over what was found and right."""
    right = [row for row in rows if row["right"]]
    return {
        "photos": len(rows),
        "right": len(right),
        "wrong": sum(row["wrong"] for row in rows),
        "ambiguous": sum(row["verdict"] == "ambiguous" for row in rows),
        "ambiguous_with_the_place": sum(row["listed"] for row in rows),
        "weak": sum(row["verdict"] == "weak" for row in rows),
        "not_found": sum(row["verdict"] == "not_found" for row in rows),
        "median_off_m": _middle([row["off_m"] for row in right]),
        "median_off_deg": _middle([row["off_deg"] for row in right]),
    }


def _middle(values: Sequence[float]) -> float | None:
    return sorted(values)[len(values) // 2] if values else None
