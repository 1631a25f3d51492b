"""The repository's documents as pages of the site, each read where it lies.

A page has the path of its file in the repository, so that links between documents hold here as they do there.
Links to what is no page, a program or a folder, become the path that they lead to. Written for readers of the
sources, the documents hold two things that a browser would need a program from elsewhere for or that Markdown
in Python reads differently: diagrams, which become tables, and lists right below a line of text.
"""

import posixpath
import re
from pathlib import Path
from typing import Any

from mkdocs.structure.files import File, Files

ROOT = Path(__file__).resolve().parents[2]
DAY = "deploy/site/pages"
DOCUMENTS = ("*.md", "deploy/*.md", "deploy/decisions/*.md", "deploy/k8s/*.md")
PICTURES = ("deploy/pictures/*",)
STYLES = "deploy/site/styles"

LINK = re.compile(r"(!?)\[((?:[^\[\]]|\[[^\]]*\])*)\]\(([^)\s#]+)(#[^)\s]*)?\)")
ELSEWHERE = re.compile(r"^[a-z]+:")
FENCE = re.compile(r"^(```.*?^```$)", re.MULTILINE | re.DOTALL)
DIAGRAM = re.compile(r"^```mermaid\n(.*?)^```$", re.MULTILINE | re.DOTALL)
ARROW = re.compile(r'^\s*(\w+)(?:\(\[(.+?)\]\))?\s*--\s*"?(.+?)"?\s*-->\s*(\w+)\s*$')
ITEM = re.compile(r"^(?:[-*]|\d+\.) ")


def on_files(files: Files, *, config: Any) -> Files:
    """Take up documents and pictures of the repository, beside the theme's files."""
    found = Files([file for file in files if file.src_dir != config.docs_dir])
    for pattern in (*DOCUMENTS, *PICTURES, f"{DAY}/*.md", f"{STYLES}/*"):
        for path in sorted(ROOT.glob(pattern)):
            found.append(_file(path, config))
    return found


def on_page_markdown(markdown: str, *, page: Any, files: Files, **_: Any) -> str:
    """A document as the site shows it."""
    markdown = DIAGRAM.sub(_table, markdown)
    parts = FENCE.split(markdown)  # blocks of code stand at the odd places
    parts[::2] = [_prose(part, page.file.src_uri, files) for part in parts[::2]]
    return "".join(parts)


def _file(path: Path, config: Any) -> File:
    name = path.relative_to(ROOT).as_posix()
    made = File.generated(config, name, abs_src_path=str(path))
    if name.startswith(f"{DAY}/"):
        made.dest_uri = f"{path.stem}/index.html"
    elif name.startswith(f"{STYLES}/"):
        made.dest_uri = path.name
    return made


def _prose(text: str, source: str, files: Files) -> str:
    return _apart(LINK.sub(lambda link: _linked(link, source, files), text))


def _linked(link: re.Match[str], source: str, files: Files) -> str:
    """A link as the site has it: to a page, a folder's page, or the path of what is none."""
    mark, text, target, anchor = link[1], link[2], link[3], link[4] or ""
    if mark or ELSEWHERE.match(target):
        return link[0]
    path = posixpath.normpath(posixpath.join(posixpath.dirname(source), target))
    if files.get_file_from_path(path):
        return link[0]
    if files.get_file_from_path(f"{path}/README.md"):
        return f"[{text}]({target}/README.md{anchor})"
    if not (ROOT / path).exists():
        return link[0]  # mkdocs says that it leads nowhere
    return text if path in text else f"{text} (`{path}`)"


def _apart(text: str) -> str:
    """A blank line before each list that begins right below text."""
    lines: list[str] = []
    for line in text.split("\n"):
        above = lines[-1] if lines else ""
        if ITEM.match(line) and above.strip() and not ITEM.match(above) and not above.startswith((" ", "#")):
            lines.append("")
        lines.append(line)
    return "\n".join(lines)


def _table(diagram: re.Match[str]) -> str:
    """Arrows of a diagram as rows: who says what to whom."""
    arrows = [ARROW.match(line) for line in diagram[1].splitlines()]
    rows = [f"| {a[2] or a[1]} | {a[3]} | {a[4]} |" for a in arrows if a]
    return "\n".join(["| from | says | to |", "|---|---|---|", *rows])
