"""The examples of the README, so that tests can run them as they stand there."""

import re
from pathlib import Path

README = Path(__file__).resolve().parents[1] / "README.md"


def examples(language: str) -> list[str]:
    """All blocks of one language, in order."""
    text = README.read_text(encoding="utf-8")
    return re.findall(rf"^```{language}\n(.*?)^```$", text, re.MULTILINE | re.DOTALL)
