"""A headless Chromium for the tests of the console."""

import shutil
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import pytest

sync_api = pytest.importorskip("playwright.sync_api", reason="playwright is not installed")
axe = pytest.importorskip("axe_playwright_python.sync_playwright", reason="axe is not installed")
CHROMIUM = shutil.which("chromium") or shutil.which("chromium-browser") or shutil.which("google-chrome")
needs_chromium = pytest.mark.skipif(CHROMIUM is None, reason="no Chromium in PATH")

FLAGS = [
    "--headless",
    "--no-sandbox",
    "--disable-gpu",
    "--use-gl=angle",
    "--use-angle=swiftshader",
    "--enable-unsafe-swiftshader",
    "--no-first-run",
    "--disable-background-networking",
    "--disable-component-update",
    "--disable-sync",
]
WAIT_MS = 60_000
"""Long, for machines that render and drive meanwhile; a condition that holds is not waited for."""
SERIOUS = {"serious", "critical"}


@contextmanager
def chromium() -> Iterator[Any]:
    """The browser."""
    with sync_api.sync_playwright() as playwright:
        browser = playwright.chromium.launch(executable_path=CHROMIUM, args=FLAGS, timeout=WAIT_MS)
        yield browser
        browser.close()


def listen(page: Any, address: str, faults: list[str]) -> None:
    """Collect what a page complains about and what it fetches from elsewhere."""
    page.on("pageerror", lambda error: faults.append(str(error)))
    page.on(
        "console",
        lambda message: (
            faults.append(f"{message.text} {message.location['url']}") if _is_fault(message) else None
        ),
    )
    page.on("request", lambda request: faults.append(request.url) if not _own(request.url, address) else None)


def _is_fault(message: Any) -> bool:
    """An error, but not that the feature service has no newest picture yet: the page asks about the next."""
    passing = "/matches?" in message.location["url"] and "status of 409" in message.text
    return message.type == "error" and not passing


def _own(url: str, address: str) -> bool:
    return url.startswith((address, "blob:", "data:"))


def inaccessible(page: Any) -> list[tuple[str, list[str]]]:
    """What axe finds seriously wrong with the page as it is: rules, and the first that break them."""
    return [
        (violation["id"], [node["html"][:120] for node in violation["nodes"]][:3])
        for violation in axe.Axe().run(page).response["violations"]
        if violation["impact"] in SERIOUS
    ]


def require_accessible(page: Any, folder: Path) -> None:
    """Nothing serious is wrong by day or by night; pictures of both are kept."""
    for scheme in ("light", "dark"):
        page.emulate_media(color_scheme=scheme)
        page.wait_for_timeout(300)
        assert inaccessible(page) == [], scheme
        page.screenshot(path=folder / f"{scheme}.png")
