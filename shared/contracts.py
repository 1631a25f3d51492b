"""`python -m shared.contracts [FOLDER]`: the bus contract as JSON Schemas, for programs in any language.

One file per message, and `index.json` with every key expression: which message travels there, how, how long
it may be. Binary fields are msgpack bin; JSON Schema has no word for that, so they stand as `format: binary`.
"""

import json
import sys
from pathlib import Path
from typing import Any

from shared.messages import all_messages
from shared.messages.base import SECTORS, Message
from shared.queries import CODED, REASONS
from shared.topics import QUERIES, TOPICS, Query, Topic
from shared.transport.keys import NAME

FOLDER = Path("deploy/contracts")
DIALECT = "https://json-schema.org/draft/2020-12/schema"


def schema(message: type[Message]) -> dict[str, Any]:
    """The JSON Schema of one message as it stands on the wire, its tag included."""
    body = message.model_json_schema(mode="validation")
    body["properties"] = {"schema": {"const": message.SCHEMA}, **body["properties"]}
    body["required"] = ["schema", *body.get("required", [])]
    return {"$schema": DIALECT, "$id": f"urn:topnav:{message.SCHEMA}", **body}


def index() -> dict[str, Any]:
    """Every key expression with what travels there."""
    return {
        "encoding": "msgpack, UTF-8; arrays are maps of dtype, shape and data (little-endian, C order)",
        "names": NAME.pattern.removesuffix(r"\Z"),
        "sectors": SECTORS,
        "topics": [_topic(topic) for topic in TOPICS],
        "queries": [_query(query) for query in QUERIES],
        "refusals": {
            "means": f"an error reply: UTF-8 text for people, with the Zenoh encoding {CODED}CODE",
            "codes": REASONS,
        },
        "liveliness": "topnav/alive/{service}/{instance}",
    }


def files() -> dict[str, str]:
    """File name -> content of the whole contract."""
    contents = {f"{message.SCHEMA}.json": schema(message) for message in all_messages()}
    contents["index.json"] = index()
    return {name: json.dumps(content, indent=2) + "\n" for name, content in contents.items()}


def _topic(topic: Topic[Message]) -> dict[str, Any]:
    return {
        "key": topic.template,
        "message": topic.message.SCHEMA,
        "delivery": topic.delivery.name.lower(),
        "delivery_means": topic.delivery.value,
        "max_bytes": topic.max_bytes,
    }


def _query(query: Query[Message, Message]) -> dict[str, Any]:
    return {
        "key": query.template,
        "request": query.request.SCHEMA,
        "reply": query.reply.SCHEMA,
        "max_bytes": query.max_bytes,
        "lapses": query.lapses,
    }


def main(arguments: list[str]) -> int:
    """Write the files into a folder and remove schemas of messages that are no more."""
    folder = Path(arguments[0]) if arguments else FOLDER
    folder.mkdir(parents=True, exist_ok=True)
    contents = files()
    for stale in folder.glob("*.json"):
        if stale.name not in contents:
            stale.unlink()
    for name, content in contents.items():
        (folder / name).write_text(content, encoding="utf-8")
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
