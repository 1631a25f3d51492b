"""Messages as JSON that Foxglove plots.

Foxglove refuses a whole channel whose JSON Schema holds a reference, a union or a null, so those of pydantic
are flattened: an optional field is declared with its type and left out of a message where it is None, and a
field of several types is in the messages but not declared. Binary content has no place in a plot and is left
out of both.
"""

import json
from typing import Any

from shared.messages.base import Message

Json = dict[str, Any]

SCALARS = {"boolean", "integer", "number", "string"}
JSON_TYPES = {bool: "boolean", int: "integer", float: "number", str: "string"}
KEPT = ("title", "description", "enum", "minimum", "maximum", "pattern")


def plain_schema(kind: type[Message]) -> bytes:
    """Flat JSON Schema of a message."""
    schema = kind.model_json_schema()
    return json.dumps(_object(schema, schema.get("$defs", {})), sort_keys=True).encode()


def plain_json(message: Message) -> bytes:
    """A message as JSON that fits `plain_schema`."""
    return json.dumps(_value(message.model_dump()), allow_nan=False).encode()


def _value(value: Any) -> Any:
    if isinstance(value, dict):
        return {name: _value(one) for name, one in value.items() if not isinstance(one, bytes | None)}
    if isinstance(value, list | tuple):
        return [_value(one) for one in value]
    return value


def _object(schema: Json, definitions: Json) -> Json:
    fields = {name: _field(one, definitions) for name, one in schema.get("properties", {}).items()}
    declared = {name: field for name, field in fields.items() if field is not None}
    return {"type": "object", "properties": declared} | _words(schema)


def _field(schema: Json, definitions: Json) -> Json | None:
    """Flat schema of one field, None where Foxglove has no type for it."""
    if "$ref" in schema:
        return _field(definitions[schema["$ref"].rpartition("/")[2]], definitions)
    choices = schema.get("anyOf") or schema.get("oneOf")
    if choices:
        kinds = [one for one in choices if one.get("type") != "null"]
        return _field(kinds[0] | _words(schema), definitions) if len(kinds) == 1 else None
    kind = schema.get("type") or _type_of_values(schema)
    if kind == "object":
        return _object(schema, definitions)
    if kind == "array":
        return _array(schema, definitions)
    if kind not in SCALARS or schema.get("format") == "binary":
        return None
    return {"type": kind} | _words(schema)


def _array(schema: Json, definitions: Json) -> Json | None:
    items = [_field(one, definitions) for one in schema.get("prefixItems", [schema.get("items", {})])]
    kinds = {None if item is None else item["type"] for item in items}
    if len(kinds) != 1 or kinds & {None, "array"}:  # Foxglove has no lists of lists
        return None
    item = items[0] if len(items) == 1 else {"type": kinds.pop()}
    return {"type": "array", "items": item} | _words(schema)


def _type_of_values(schema: Json) -> str | None:
    values = schema.get("enum", [schema.get("const")])
    kinds = {JSON_TYPES.get(type(value)) for value in values}
    return kinds.pop() if len(kinds) == 1 else None


def _words(schema: Json) -> Json:
    return {word: schema[word] for word in KEPT if word in schema}
