"""Variable interpolation of the Compose specification: $VAR, ${VAR}, ${VAR:-default}, ${VAR:?message}, $$."""

import re
from collections.abc import Mapping

VARIABLE = re.compile(
    r"\$(?:(?P<escaped>\$)"
    r"|(?P<plain>[A-Za-z_]\w*)"
    r"|\{(?P<name>[A-Za-z_]\w*)(?:(?P<operator>:?[-?])(?P<argument>[^${}]*))?\}"
    r"|(?P<bad>))"
)


class MissingVariableError(ValueError):
    """A variable that the file requires is not set."""


def interpolate(text: str, variables: Mapping[str, str]) -> str:
    """Replace the variables in `text`.

    With a colon an empty value counts as unset, without one only an absent value does.

    Raises:
        MissingVariableError: `${VAR:?message}` and VAR is not set.
        ValueError: a `$` that starts none of the supported forms.
    """
    return VARIABLE.sub(lambda match: _value(match, text, variables), text)


def interpolate_tree(node: object, variables: Mapping[str, str]) -> object:
    """Interpolate every string of a parsed YAML document; keys stay as they are."""
    if isinstance(node, str):
        return interpolate(node, variables)
    if isinstance(node, list):
        return [interpolate_tree(item, variables) for item in node]
    if isinstance(node, dict):
        return {key: interpolate_tree(value, variables) for key, value in node.items()}
    return node


def _value(match: re.Match[str], text: str, variables: Mapping[str, str]) -> str:
    if match["bad"] is not None:
        raise ValueError(f"cannot interpolate {text!r} at {text[match.start() :]!r}; write $$ for a plain $")
    if match["escaped"]:
        return "$"
    if match["plain"]:
        return variables.get(match["plain"], "")
    name, operator, argument = match["name"], match["operator"] or "", match["argument"] or ""
    value = variables.get(name)
    unset = value is None or (operator.startswith(":") and value == "")
    if not unset and value is not None:
        return value
    if operator.endswith("?"):
        raise MissingVariableError(f"{name} is not set: {argument or 'a value is required'}")
    return argument if operator.endswith("-") else ""
