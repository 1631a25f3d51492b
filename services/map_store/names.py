"""Path parameters of REST: the bus's rule for names, and node ids that a database holds."""

from typing import Annotated

from fastapi import Path

from services.map_store.graph import MAX_NODE_ID

MapName = Annotated[str, Path(alias="map", pattern=r"^[a-z0-9_-]{1,64}$", description="name of the map")]
NodeId = Annotated[int, Path(ge=0, le=MAX_NODE_ID, description="number of the node")]
