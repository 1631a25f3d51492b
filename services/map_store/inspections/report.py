"""A round as one page: both pictures of every place, turned alike, changes marked. Pure.

Nothing is decoded here: a picture is turned by showing it twice, side by side, in a frame of its width. The
page needs no other file, and has no styles: it is shown where a site forbids styles in pages.
"""

import base64
import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from datetime import UTC, datetime
from html import escape

from shared.messages.inspections import Inspection, Region

WIDTH, HEIGHT = 1000, 500
"""Of a picture's coordinates on the page: longitude and latitude."""
NUMBER = 'font-size="28" fill="#ff2d20"'
MARK = 'fill="none" stroke="#ff2d20" stroke-width="4"'


@dataclass(frozen=True)
class Shown:
    """A visit, and the one it was compared with, if that is still kept."""

    visit: Inspection
    earlier: Inspection | None


def page(map_name: str, round_id: str, shown: Sequence[Shown]) -> str:
    """The whole page as HTML."""
    changes = sum(len(each.visit.regions) for each in shown)
    title = escape(f"Inspection {round_id} of {map_name}")
    parts = [
        f'<!doctype html><html lang="en"><head><meta charset="utf-8"><title>{title}</title></head><body>',
        f"<h1>{title}</h1><p>{len(shown)} places, {changes} changes.</p>",
        *(line for each in shown for line in _visit(each)),
        "</body></html>",
    ]
    return "\n".join(parts)


def _visit(shown: Shown) -> Iterator[str]:
    visit, earlier = shown.visit, shown.earlier
    yield f"<h2>{escape(visit.place)}</h2>"
    yield f"<p>{escape(_summary(visit))}</p>"
    if earlier is not None and visit.yaw_rad is not None:
        yield _figure("before", earlier, visit.yaw_rad, visit.regions)
    yield _figure("now", visit, 0.0, visit.regions)


def _summary(visit: Inspection) -> str:
    if visit.against_ns is None:
        return f"Not compared: {visit.why}." if visit.why else "Not compared."
    if not visit.regions:
        return f"Nothing changed since {_time(visit.against_ns)}."
    told = ", ".join(
        f"{number}: {math.degrees(each.bearing_rad):+.0f} degrees to the left, "
        f"{math.degrees(each.elevation_rad):+.0f} up, {math.degrees(each.width_rad):.0f} wide"
        for number, each in enumerate(visit.regions, start=1)
    )
    return f"{len(visit.regions)} changes since {_time(visit.against_ns)}: {told}."


def _figure(what: str, visit: Inspection, yaw_rad: float, regions: Sequence[Region]) -> str:
    """One picture seen from a camera turned by `yaw_rad` from the one that took it, with numbered boxes."""
    shift = round(yaw_rad / math.tau * WIDTH) % WIDTH
    data = base64.b64encode(visit.picture).decode()
    size = f'y="0" width="{WIDTH}" height="{HEIGHT}" preserveAspectRatio="none"'
    source = f'href="data:image/jpeg;base64,{data}"'
    again = f'<use href="#{_name(what, visit)}" x="-{WIDTH}"/>' if shift else ""
    boxes = "".join(_box(number, each) for number, each in enumerate(regions, start=1))
    return (
        f"<figure><figcaption>{what}, {_time(visit.stamp_ns)}</figcaption>"
        f'<svg viewBox="0 0 {WIDTH} {HEIGHT}" width="100%">'
        f'<image id="{_name(what, visit)}" x="{shift}" {size} {source}/>{again}{boxes}</svg></figure>'
    )


def _name(what: str, visit: Inspection) -> str:
    return f"{what}-{visit.stamp_ns}"


def _box(number: int, region: Region) -> str:
    """A box round a region; one across the seam is drawn at both edges."""
    wide, high = region.width_rad / math.tau * WIDTH, region.height_rad / math.pi * HEIGHT
    left = (0.5 - region.bearing_rad / math.tau) * WIDTH - wide / 2
    top = (0.5 - region.elevation_rad / math.pi) * HEIGHT - high / 2
    drawn = []
    for x in (left - WIDTH, left, left + WIDTH):
        if x + wide > 0.0 and x < WIDTH:
            drawn.append(f'<rect x="{x:.0f}" y="{top:.0f}" width="{wide:.0f}" height="{high:.0f}" {MARK}/>')
            drawn.append(f'<text x="{x + 6:.0f}" y="{top + 28:.0f}" {NUMBER}>{number}</text>')
    return "".join(drawn)


def _time(stamp_ns: int) -> str:
    return datetime.fromtimestamp(stamp_ns / 1e9, UTC).strftime("%Y-%m-%d %H:%M:%S UTC")
