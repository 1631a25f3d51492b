"""One picture, asked about over HTTP as a user would, and what came of it."""

import math
from collections.abc import Mapping, Sequence
from typing import Any

import cv2
import httpx
import numpy as np

from services.launcher.client.failure import ExperimentError
from shared.messages.sensors import Frame
from shared.messages.simulation import Pose

RIGHT_M = 1.5
"""A node this near is the right one: nodes are 0.7 m apart, and the second nearest is right as well."""
TIMEOUT_S = 30.0
"""For one answer; a busy machine needs a second."""


def ask(http: httpx.Client, robot: str, map_name: str, frame: Frame) -> dict[str, Any]:
    """What goal-check says of a picture.

    Raises:
        ExperimentError: it was refused.
    """
    pixels = np.frombuffer(frame.data, np.uint8).reshape(frame.height_px, frame.width_px, 3)
    _, coded = cv2.imencode(".png", pixels)
    url, headers = f"/api/robots/{robot}/goal-check", {"content-type": "image/png"}
    answer = http.post(
        url, params={"map": map_name}, content=coded.tobytes(), headers=headers, timeout=TIMEOUT_S
    )
    if answer.status_code != httpx.codes.OK:
        raise ExperimentError(f"goal-check answered {answer.status_code}: {answer.text[:300]}")
    told: dict[str, Any] = answer.json()
    return told


def judge(answer: Mapping[str, Any], pose: Pose, nodes: Mapping[int, Pose]) -> dict[str, Any]:
    """An answer against the truth: how far the best node of each named place is from the picture's pose."""
    away = [min(_away_m(nodes[n], pose) for n in place["nodes"]) for place in answer["places"]]
    return {
        "x_m": round(pose.x_m, 2),
        "y_m": round(pose.y_m, 2),
        "verdict": answer["verdict"],
        "places": len(away),
        "first_off_m": round(away[0], 2) if away else None,
        "listed": any(distance <= RIGHT_M for distance in away),
    }


def summary(rows: Sequence[Mapping[str, Any]]) -> dict[str, int]:
    """Counts: `single` one place is named as the right one, `list` several are."""
    single = [row for row in rows if row["verdict"] == "found"]
    several = [row for row in rows if row["verdict"] == "ambiguous"]
    return {
        "pictures": len(rows),
        "single": len(single),
        "single_wrong": sum(not row["listed"] for row in single),
        "list": len(several),
        "list_with_the_place": sum(row["listed"] for row in several),
        "weak": sum(row["verdict"] == "weak" for row in rows),
        "weak_with_the_place": sum(row["verdict"] == "weak" and row["listed"] for row in rows),
        "not_found": sum(row["verdict"] == "not_found" for row in rows),
    }


def _away_m(node: Pose, pose: Pose) -> float:
    return math.hypot(node.x_m - pose.x_m, node.y_m - pose.y_m)
