"""Parameters of a mission from the shell: JSON where they are JSON, else text; anything else is refused."""

import pytest
import typer

from services.launcher.terminal.options import named_value


@pytest.mark.parametrize(
    ("text", "parameter"),
    [
        ("frames=3", ("frames", 3)),
        ("fast=true", ("fast", True)),
        ('places=["dock", "door"]', ("places", ["dock", "door"])),
        ("name=kitchen", ("name", "kitchen")),
        ("note=a=b", ("note", "a=b")),
        ("empty=", ("empty", "")),
    ],
)
def test_values_are_json_or_text(text, parameter):
    assert named_value(text) == parameter


@pytest.mark.parametrize("text", ["frames", "=3", ""])
def test_what_names_nothing_is_refused(text):
    with pytest.raises(typer.BadParameter, match="NAME=VALUE"):
        named_value(text)
