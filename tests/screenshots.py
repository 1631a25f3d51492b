"""Pictures of every view of the console, from a real stack: `make screenshots`.

They go to deploy/pictures as console-<view>-<width>-<scheme>.jpg; the README shows some of them.
"""

import itertools
import tempfile
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np

from services.launcher.client.stack import StackChoice, open_stack
from services.launcher.evaluation.exploration import explore
from services.launcher.evaluation.rounds import Game
from simulator.world.freespace import free_space
from simulator.world.world_file import load_world
from tests.browser import WAIT_MS, chromium
from tests.e2e.one_stack.test_console import png_of

PICTURES = Path(__file__).resolve().parents[1] / "deploy" / "pictures"
WORLD, MAP, STEPS = "apartment", "flat", 450
SIZES = ((1440, 900), (390, 844))
SCHEMES = ("light", "dark")


def drive(page: Any) -> None:
    """Matches over the live picture."""
    page.check("#show-matches")
    page.wait_for_timeout(2500)


def the_map(page: Any) -> None:
    """One connection with its evidence."""
    page.fill("#find", "3-5")
    page.press("#find", "Enter")
    page.wait_for_selector("#pair-answer[data-drawn]", timeout=WAIT_MS)


def why(page: Any) -> None:
    """Charts of the last steps."""
    page.wait_for_selector("#charts .uplot", timeout=WAIT_MS)


def nothing(page: Any) -> None:
    """The view as it opens."""


VIEWS: dict[str, Callable[[Any], None]] = {
    "drive": drive,
    "map": the_map,
    "why": why,
    "maps": nothing,
    "runs": nothing,
}


def main() -> None:
    """Explore, start a drive to a picture, and take the pictures meanwhile."""
    space = free_space(load_world(WORLD))
    with (
        tempfile.TemporaryDirectory() as folder,
        chromium() as browser,
        open_stack(StackChoice(Path(folder), WORLD, seed=1, lockstep=True)) as stack,
    ):
        explore(stack, WORLD, MAP, seed=1, max_steps=STEPS)
        game = Game(stack, space, MAP, np.random.default_rng(2))
        for (width, height), scheme in itertools.product(SIZES, SCHEMES):
            game.begin(seed=1)
            goal = png_of(game.hide(game.choose()[1]))
            page = browser.new_page(viewport={"width": width, "height": height}, color_scheme=scheme)
            _start(page, str(stack.gateway_url), goal)
            _take(page, f"{width}-{scheme}", whole=width < 500)
            page.click("nav a[data-view=drive]")
            page.evaluate("document.getElementById('cancel').click()")  # nothing once the drive has ended
            page.close()


def _start(page: Any, address: str, goal: bytes) -> None:
    page.goto(address)
    page.wait_for_selector("#frame:visible", timeout=WAIT_MS)
    picture = {"name": "goal.png", "mimeType": "image/png", "buffer": goal}
    page.set_input_files("#picture", files=[picture])
    page.wait_for_selector("#goal-answer .verdict", timeout=WAIT_MS)
    page.click("#go")
    page.wait_for_timeout(1500)


def _take(page: Any, kind: str, whole: bool) -> None:
    for view, prepare in VIEWS.items():
        page.click(f"nav a[data-view={view}]")
        page.wait_for_timeout(1200)
        prepare(page)
        page.evaluate("scrollTo(0, 0)")
        page.screenshot(
            path=PICTURES / f"console-{view}-{kind}.jpg", type="jpeg", quality=80, full_page=whole
        )


if __name__ == "__main__":
    main()
