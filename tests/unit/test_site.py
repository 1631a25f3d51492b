"""The documentation site builds without a warning, fetches nothing, and shows commands that there are."""

import os
import re
import shlex
import subprocess
import sys
from functools import cache
from html.parser import HTMLParser
from importlib.util import find_spec
from pathlib import Path
from typing import Any

import pytest
import typer
import yaml

from services.gateway.app import create_app
from services.gateway.settings import GatewaySettings
from services.launcher import cli
from shared.bus import Bus
from tests.readme import PAGES, REPOSITORY

SITE = REPOSITORY / "deploy" / "site"
STEPS = ["try", "map", "drive", "patrol", "robot", "operate", "extend"]
DAY = [SITE / "pages" / f"{step}.md" for step in STEPS]
DOCUMENTS = [page for page in PAGES if "decisions" not in page.parts]

FENCED = re.compile(r"^```(?:bash|sh)\n(.*?)^```$", re.MULTILINE | re.DOTALL)
INDENTED = re.compile(r"^    (.*)$", re.MULTILINE)
INLINE = re.compile(r"`([^`\n]+)`")
COMMAND = re.compile(r"(?:^|[;&|(] ?|\w+=\S+ )topnav((?: [^;&|#\n]*)?)", re.MULTILINE)
TARGET = re.compile(r"^(?:\w+=\S+ )?make((?: [a-z-]+)+)", re.MULTILINE)
REQUEST = re.compile(r"(?:(GET|POST|PUT|DELETE|PATCH) )?(/(?:api/[^\s?`\"']+|readyz|healthz|metrics))")


def code_in(page: Path) -> list[str]:
    """What a page shows as code for a shell: blocks, and spans in its text."""
    text = page.read_text(encoding="utf-8")
    prose = re.sub(r"^```.*?^```$", "", text, flags=re.MULTILINE | re.DOTALL)
    return [*FENCED.findall(text), *INDENTED.findall(prose), *INLINE.findall(prose)]


def named(page: Path) -> str:
    return str(page.relative_to(REPOSITORY))


@pytest.fixture(scope="module")
def built(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The site as `make docs` builds it."""
    if find_spec("mkdocs") is None or find_spec("material") is None:
        pytest.skip("mkdocs-material is not installed: pip install 'topnav[docs]'")
    folder = tmp_path_factory.mktemp("site")
    command = [sys.executable, "-m", "mkdocs", "build", "--strict", "--site-dir", str(folder)]
    command += ["--config-file", str(SITE / "mkdocs.yml")]
    environment = os.environ | {"NO_MKDOCS_2_WARNING": "1"}
    run = subprocess.run(command, env=environment, capture_output=True, text=True, timeout=150, check=False)
    assert run.returncode == 0, run.stdout + run.stderr
    return folder


class Loaded(HTMLParser):
    """Collects what a browser fetches for a page by itself: not what a reader may click on."""

    def __init__(self) -> None:
        super().__init__()
        self.addresses: list[str] = []

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        name = {"script": "src", "img": "src", "iframe": "src", "link": "href"}.get(tag)
        self.addresses += [value for key, value in attrs if key == name and value]


def test_each_step_of_the_day_and_each_document_is_a_page(built):
    pages = {path.relative_to(built).as_posix() for path in built.rglob("index.html")}
    assert {"index.html", *(f"{step}/index.html" for step in STEPS)} <= pages
    assert {f"deploy/{path.stem}/index.html" for path in (REPOSITORY / "deploy").glob("*.md")} <= pages
    decisions = (REPOSITORY / "deploy" / "decisions").glob("0*.md")
    assert {f"deploy/decisions/{path.stem}/index.html" for path in decisions} <= pages


@pytest.fixture(scope="module")
def loads(built: Path) -> list[tuple[Path, str]]:
    """Every page with each address that it loads."""
    found = []
    for path in built.rglob("*.html"):
        loaded = Loaded()
        loaded.feed(path.read_text(encoding="utf-8"))
        found += [(path, address) for address in loaded.addresses]
    return found


def test_no_page_fetches_anything_from_elsewhere(loads):
    assert len(loads) > 100
    assert [f"{path}: {address}" for path, address in loads if re.match(r"\w+:|//", address)] == []
    pages = {path for path, _ in loads}
    assert not [path for path in pages if 'class="mermaid"' in path.read_text("utf-8")], (
        "the theme fetches what draws it"
    )


def test_what_pages_load_is_there(loads):
    there = {
        (path.parent / address.partition("?")[0]) for path, address in loads if path.name == "index.html"
    }
    assert [str(path) for path in there if not path.exists()] == []


def test_links_to_programs_become_their_paths_diagrams_tables_and_lists_lists(built):
    overview = (built / "index.html").read_text(encoding="utf-8")
    assert "<code>deploy/examples/swap_drive.py</code> is a drive controller" in overview
    assert re.search(r"<td>simulator</td>\s*<td>frame</td>\s*<td>features</td>", overview)
    threats = (built / "deploy/THREATS/index.html").read_text(encoding="utf-8")
    assert "<li>tokens with roles" in threats, "a list right below a line of text"


def sections() -> list[Any]:
    """The steps and their pages, as mkdocs.yml has them."""
    found = yaml.safe_load((SITE / "mkdocs.yml").read_text(encoding="utf-8"))["nav"]
    assert isinstance(found, list)
    return found


@pytest.mark.parametrize("step", STEPS)
def test_the_side_of_a_step_names_its_pages(built, step):
    pages = next(section[step.capitalize()] for section in sections() if step.capitalize() in section)
    shown = re.findall(
        r'<span class="md-ellipsis">\s*(.*?)\s*<', (built / step / "index.html").read_text("utf-8")
    )
    assert {title for page in pages[1:] for title in page} <= set(shown)


def test_the_steps_are_in_the_order_of_a_day():
    titles = [next(iter(section)) for section in sections()]
    assert titles == ["Overview", *(step.capitalize() for step in STEPS)]
    assert [section[title][0] for section, title in zip(sections(), titles, strict=True)][1:] == [
        named(page) for page in DAY
    ]


@cache
def topnav() -> Any:
    """The command and all below it."""
    return typer.main.get_command(cli.app)


def wrong(words: list[str]) -> str | None:
    """What of `topnav WORD...` there is not; None for a command as it is."""
    command = topnav()
    for word in words:
        option = word.partition("=")[0]
        if option.startswith("--"):
            known = {name for one in command.params for name in (*one.opts, *one.secondary_opts)}
            if option not in known | {"--help"}:
                return option
        elif hasattr(command, "commands") and not word.isupper():
            if word not in command.commands:
                return word
            command = command.commands[word]
    return None


def commands_in(page: Path) -> list[str]:
    found = [rest.strip() for code in code_in(page) for rest in COMMAND.findall(code)]
    return [re.sub(r"[\[\]]|\.\.\.", "", rest) if "=[" not in rest else rest for rest in found]


@pytest.mark.parametrize("page", DOCUMENTS, ids=named)
def test_commands_and_their_options_exist(page):
    assert {rest: what for rest in commands_in(page) if (what := wrong(shlex.split(rest)))} == {}


@pytest.mark.parametrize("page", DOCUMENTS, ids=named)
def test_targets_of_make_exist(page):
    makefile = (REPOSITORY / "Makefile").read_text(encoding="utf-8")
    known = set(re.findall(r"^([a-z-]+):", makefile, re.MULTILINE))
    asked = {word for code in code_in(page) for words in TARGET.findall(code) for word in words.split()}
    assert asked <= known


@pytest.fixture(scope="module")
def routes() -> set[tuple[str, str]]:
    """Method and path of all that the gateway answers."""
    paths = create_app(GatewaySettings(), Bus(None)).openapi()["paths"]  # type: ignore[arg-type]
    return {(method.upper(), path) for path, methods in paths.items() for method in methods}


@pytest.mark.parametrize("page", DAY, ids=named)
def test_requests_are_answered(page, routes):
    asked = [request for code in code_in(page) for request in REQUEST.findall(code)]
    for method, path in asked:
        fits = [m for m, known in routes if re.fullmatch(re.sub(r"\{\w+\}", "[^/]+", known), path)]
        assert (method in fits) if method else fits, f"{method} {path}"


def test_the_steps_show_commands_and_requests():
    """What is looked for above is found."""
    assert all(commands_in(page) or TARGET.findall("\n".join(code_in(page))) for page in DAY)
    assert sum(bool(REQUEST.search("\n".join(code_in(page)))) for page in DAY) >= 3
