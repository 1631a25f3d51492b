"""Interpolation of the Compose specification."""

import pytest

from services.launcher.compose.interpolate import MissingVariableError, interpolate, interpolate_tree

VARIABLES = {"SET": "value", "EMPTY": ""}


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("plain", "plain"),
        ("$SET/x", "value/x"),
        ("${SET}x", "valuex"),
        ("${SET:-other}", "value"),
        ("${EMPTY:-other}", "other"),
        ("${EMPTY-other}", ""),
        ("${GONE:-http://h:1/}", "http://h:1/"),
        ("${GONE-other}", "other"),
        ("${GONE:-}", ""),
        ("${GONE}", ""),
        ("${SET:?must be set}", "value"),
        ("${EMPTY?must be set}", ""),
        ("$$SET costs $$5", "$SET costs $5"),
        ("${SET}:${GONE:-1}:${GONE:-2}", "value:1:2"),
    ],
)
def test_variables_are_replaced_as_compose_does(text, expected):
    assert interpolate(text, VARIABLES) == expected


@pytest.mark.parametrize(
    "text", ["${GONE:?set it in .env}", "${EMPTY:?set it in .env}", "${GONE?set it in .env}"]
)
def test_a_required_variable_that_is_missing_is_named_with_its_message(text):
    with pytest.raises(MissingVariableError, match=r"(GONE|EMPTY) is not set: set it in \.env"):
        interpolate(text, VARIABLES)


@pytest.mark.parametrize("text", ["${", "${A:+b}", "$5", "${A:-${B}}", "trailing $"])
def test_unsupported_forms_are_refused_not_passed_on(text):
    with pytest.raises(ValueError, match="cannot interpolate"):
        interpolate(text, VARIABLES)


def test_a_document_is_interpolated_to_its_leaves_and_other_types_stay():
    document = {"a": ["$SET", 1, None], "b": {"c": "${GONE:-d}"}, "on": True}
    assert interpolate_tree(document, VARIABLES) == {"a": ["value", 1, None], "b": {"c": "d"}, "on": True}
