"""The examples of the README and of the pages in deploy, so that tests can run them as they stand there."""

import re
from pathlib import Path

REPOSITORY = Path(__file__).resolve().parents[1]
README = REPOSITORY / "README.md"
PAGES = (README, *sorted((REPOSITORY / "deploy").rglob("*.md")))


def examples(language: str, page: Path = README) -> list[str]:
    """All blocks of one language in a page, in order."""
    text = page.read_text(encoding="utf-8")
    return re.findall(rf"^```{language}\n(.*?)^```$", text, re.MULTILINE | re.DOTALL)
