"""Names of the records that commands leave."""

from datetime import datetime

import pytest

from shared.runs import CommandRun


@pytest.mark.parametrize(
    ("command", "ended", "name"),
    [
        ("explore", "2026-03-01T09:05:06Z", "20260301T090506Z-explore.json"),
        ("hide --suite thesis", "2026-03-01T23:05:06-02:00", "20260302T010506Z-hide-suite-thesis.json"),
        ("study ../../x", "2026-03-01T09:05:06.9Z", "20260301T090506Z-study-x.json"),
    ],
)
def test_a_name_is_the_moment_in_utc_and_plain_words(command: str, ended: str, name: str) -> None:
    run = CommandRun(
        command=command, started=datetime.fromisoformat(ended), ended=datetime.fromisoformat(ended)
    )
    assert run.file_name == name
