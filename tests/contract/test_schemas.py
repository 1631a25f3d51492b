"""The committed JSON Schemas are those of the code, and describe what really is on the wire."""

from pathlib import Path
from typing import Any

import jsonschema
import msgpack
import pytest

from shared.contracts import FOLDER, files, main, schema
from shared.messages import all_messages
from shared.messages.base import Message
from shared.topics import QUERIES, TOPICS
from shared.wire import encode
from tests.contract.samples import samples

ROOT = Path(__file__).parents[2]
KINDS = [pytest.param(kind, id=kind.SCHEMA) for kind in all_messages()]


def test_committed_files_are_up_to_date():
    committed = {path.name: path.read_text(encoding="utf-8") for path in (ROOT / FOLDER).iterdir()}
    assert committed == files(), "run `python -m shared.contracts` and commit deploy/contracts"


def test_command_removes_schemas_of_messages_that_are_no_more(tmp_path: Path):
    (tmp_path / "gone.v1.json").write_text("{}")
    assert main([str(tmp_path)]) == 0
    assert {path.name for path in tmp_path.iterdir()} == files().keys()


@pytest.mark.parametrize("kind", KINDS)
def test_schema_accepts_the_message_as_sent_and_refuses_another_tag(kind: type[Message]):
    validator = jsonschema.Draft202012Validator(schema(kind))
    sent = _as_json(msgpack.unpackb(encode(samples()[kind])))
    validator.validate(sent)
    assert not validator.is_valid(sent | {"schema": "another.v1"})
    for name, field in kind.model_fields.items():
        if field.is_required():
            assert not validator.is_valid({key: value for key, value in sent.items() if key != name})


def test_every_message_travels_on_some_key():
    travelling = {topic.message for topic in TOPICS}
    travelling |= {kind for query in QUERIES for kind in (query.request, query.reply)}
    assert travelling == set(all_messages())


def _as_json(content: Any) -> Any:
    """Binary as text, the way the schemas describe it."""
    if isinstance(content, dict):
        return {key: _as_json(value) for key, value in content.items()}
    if isinstance(content, list):
        return [_as_json(value) for value in content]
    return content.decode("latin-1") if isinstance(content, bytes) else content
