"""Parameters of REST: the bus's rule for names, node ids that a database holds, and who writes."""

from typing import Annotated

from fastapi import Header, Path
from pydantic import AfterValidator

from services.map_store.storage.graph import MAX_NODE_ID

MapName = Annotated[str, Path(alias="map", pattern=r"^[a-z0-9_-]{1,64}$", description="name of the map")]
NodeId = Annotated[int, Path(ge=0, le=MAX_NODE_ID, description="number of the node")]

AUTHOR = "rest"
"""Who wrote a revision when the header does not say."""

SERVICES = frozenset({"planner"})
"""Authors that write over the bus and skip deltas in their own name: a person of that name goes unseen."""


def _no_service(author: str) -> str:
    if author in SERVICES:
        raise ValueError(f"{author!r} is a service's own name; choose another")
    return author


Author = Annotated[
    str,
    Header(
        alias="X-Topnav-Author",
        pattern=r"^[a-z0-9_.-]{1,32}$",
        description="who writes, as the history shall show it; not the name of a service",
    ),
    AfterValidator(_no_service),
]
