"""Which pairs went wrong, worst first, and the pictures and the page that show them."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path

import cv2

from experiments.photographs.comparing import Answer, verified
from experiments.photographs.eyes import Eyes
from experiments.photographs.looks import picture_of
from experiments.photographs.pair_picture import Caption, pair_picture
from experiments.photographs.study import Found
from experiments.photographs.tables import LinkAnswer
from experiments.work.page import markdown_table
from experiments.work.reliability import RIGHT_DEG
from services.launcher.client.failure import ExperimentError

UNANSWERED_MOST = 20
PICTURES_MOST = 300
"""A megabyte each; chosen: more than anybody looks through."""

PAGE = "index.md"


@dataclass(frozen=True)
class Failure:
    """One pair that went wrong.

    Attributes:
        kind: wrong edge, wrong heading or unanswered.
        answer: what was made of it.
        true_deg: the known bearing; None of a wrong edge.
    """

    kind: str
    answer: Answer
    true_deg: float | None = None
    off_deg: float | None = None


def failures_of(found: Found) -> list[Failure]:
    """Wrong edges by inliers, wrong headings by error, then unanswered links by raw matches."""
    edges = [one for tour in found.tours for one in tour.wrong] + found.foreign_wrong
    edges.sort(key=lambda one: -one.inliers)
    return [
        *(Failure("wrong edge", one) for one in edges),
        *(Failure("wrong heading", link.answer, link.bearing_deg, off) for off, link in _wrong(found.links)),
        *(Failure("unanswered", one.answer, one.bearing_deg) for one in _unanswered(found.links)),
    ]


def draw_failures(folder: Path, found: Found, eyes: Eyes, tick: Callable[[str], None]) -> Path:
    """A picture for each failure and a page that lists them.

    Raises:
        ExperimentError: the folder holds anything else than failures.
    """
    folder.mkdir(parents=True, exist_ok=True)
    _clear(folder)
    failures, rows = failures_of(found), []
    for number, failure in enumerate(failures[:PICTURES_MOST], start=1):
        tick(f"failures: {number} of {len(failures)}")
        rows.append(_draw(folder, number, failure, found, eyes))
    left_out = len(failures) - len(rows)
    lines = ["# Pairs that went wrong, worst first", ""]
    lines += markdown_table(rows) if rows else ["None."]
    lines += ["", f"{left_out} more are not drawn."] if left_out else []
    page = folder / PAGE
    page.write_text("\n".join(lines) + "\n", encoding="utf-8")
    return page


def _draw(folder: Path, number: int, failure: Failure, found: Found, eyes: Eyes) -> dict[str, object]:
    answer = failure.answer
    (one, path), (other, candidate_path) = (_named(found, n) for n in (answer.query, answer.candidate))
    question = found.question(answer.query, [answer.candidate])
    match, _ = verified(question, question.candidates[0], eyes.pipeline, eyes.way.seed)
    figures = (
        f"{match.inliers} of {match.raw_matches} matches agree, two-view {match.status}, "
        f"confidence {match.confidence:.2f}"
    )
    off = f"{failure.off_deg:.0f} deg off" if failure.off_deg is not None else "places differ"
    off = "no answer" if failure.kind == "unanswered" else off
    caption = Caption(f"{failure.kind}: {one} to {other}, {off}", figures, _method(answer))
    picture = pair_picture(
        (picture_of(path), picture_of(candidate_path)), match, answer.heading_deg, failure.true_deg, caption
    )
    name = f"{number:03d}-{failure.kind}-{one}-{other}.png".replace(" ", "_").replace("/", "_")
    cv2.imwrite(str(folder / name), picture)
    return {
        "picture": f"[{number:03d}]({name})",
        "kind": failure.kind,
        "frame": one,
        "candidate": other,
        "off (deg)": failure.off_deg,
        "answered (deg)": answer.heading_deg,
        "true (deg)": failure.true_deg,
        "inliers": answer.inliers,
        "raw matches": answer.raw_matches,
        "confidence": answer.confidence,
        "method": answer.method,
    }


def _method(answer: Answer) -> str:
    """What gave the heading, as the caption says it: 'two-view', or the number of a method of the thesis."""
    return "two-view" if answer.method == "epipolar" else f"method {answer.method}"


def _wrong(links: Sequence[LinkAnswer]) -> list[tuple[float, LinkAnswer]]:
    wrong = [(link.off_deg, link) for link in links if link.off_deg is not None and link.off_deg > RIGHT_DEG]
    return sorted(wrong, key=lambda one: -one[0])


def _unanswered(links: Sequence[LinkAnswer]) -> list[LinkAnswer]:
    none = [link for link in links if link.off_deg is None]
    return sorted(none, key=lambda link: -link.answer.raw_matches)[:UNANSWERED_MOST]


def _named(found: Found, number: int) -> tuple[str, Path]:
    tour = next(one for one in reversed(found.tours) if one.first <= number)
    own = number - tour.first
    return f"{tour.tour.file.name}/{tour.tour.file.pictures[own]}", tour.tour.paths[own]


def _clear(folder: Path) -> None:
    """Earlier failures go, so that none of them is taken for a new one; nothing else is touched."""
    there = sorted(folder.iterdir())
    strange = [
        one.name
        for one in there
        if one.name != PAGE and not (one.suffix == ".png" and one.name[:3].isdigit())
    ]
    if strange:
        raise ExperimentError(
            f"--failures {folder}: expected an empty folder or one of earlier failures, got "
            f"{', '.join(strange[:3])}: choose another folder"
        )
    for one in there:
        one.unlink()
