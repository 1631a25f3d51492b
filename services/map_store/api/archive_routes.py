"""REST: a map to and from one file."""

import errno
import tempfile
from collections.abc import Iterator, Sequence
from contextlib import ExitStack, contextmanager
from functools import partial
from typing import IO, Annotated, Any

from fastapi import APIRouter, Query, Request
from fastapi.concurrency import run_in_threadpool
from fastapi.params import Depends
from fastapi.responses import StreamingResponse

from services.map_store.api.names import AUTHOR, Author, MapName
from services.map_store.api.schemas import MapView, map_view
from services.map_store.errors import CorruptError, StorageFullError
from services.map_store.storage.archive import Archive, write_archive
from services.map_store.store import MapStore

ZIP: dict[int | str, dict[str, Any]] = {200: {"content": {"application/zip": {}}}}
IN_MEMORY_BYTES = 8_000_000
"""An archive up to this long needs no file: 50 nodes of 300 SIFT descriptors, 0.16 MB each."""

CHUNK_BYTES = 1_000_000
"""Read and sent at once; so much memory a slow reader holds."""

FULL = frozenset({errno.ENOSPC, errno.EDQUOT, errno.ENOENT})
"""What a full disk says; ENOENT because then `tempfile` finds no folder that it can write to."""
NewName = Annotated[str | None, Query(alias="name", pattern=r"^[a-z0-9_-]{1,64}$")]


def build(store: MapStore, write: Sequence[Depends], max_bytes: int) -> APIRouter:
    """Routes /maps/{map}/export and /maps/import."""
    router = APIRouter(prefix="/maps", tags=["archives"])

    @router.get("/{map}/export", response_class=StreamingResponse, responses=ZIP)
    def export_map(name: MapName) -> StreamingResponse:
        """The newest revision as a zip; the same map always gives the same bytes."""
        revision, graph = store.graph(name)
        with _room(), ExitStack() as opened:
            file = opened.enter_context(tempfile.SpooledTemporaryFile(IN_MEMORY_BYTES))
            try:
                write_archive(file, name, revision, graph, partial(store.contents.read, name))
            except CorruptError as error:
                raise CorruptError(f"{error}, then export again") from None
            file.flush()
            opened.pop_all()  # _chunks closes it
        headers = {"Content-Disposition": f'attachment; filename="{name}.zip"'}
        return StreamingResponse(_chunks(file), media_type="application/zip", headers=headers)

    @router.post(
        "/import",
        status_code=201,
        dependencies=write,
        openapi_extra={"requestBody": {"content": {"application/zip": {}}, "required": True}},
    )
    async def import_map(request: Request, name: NewName = None, author: Author = AUTHOR) -> MapView:
        """Make a map from an exported file, under its own name or `name`. It must not exist."""
        with _room(), tempfile.SpooledTemporaryFile(IN_MEMORY_BYTES) as file:
            async for chunk in request.stream():
                await run_in_threadpool(file.write, chunk)
            return await run_in_threadpool(_import, store, file, max_bytes, name, author)

    return router


def _import(store: MapStore, file: IO[bytes], max_bytes: int, name: str | None, author: str) -> MapView:
    file.seek(0)
    archive = Archive(file, max_bytes)
    name = name or archive.index.name
    store.restore(name, archive.steps, archive.blob, author)
    return map_view(store.summary(name))


@contextmanager
def _room() -> Iterator[None]:
    """Archives wait in temporary files; a disk without room for them is the client's to know about."""
    try:
        yield
    except OSError as error:
        if error.errno not in FULL:
            raise
        full = f"no room for an archive in the folder for temporary files: {error.strerror}"
        raise StorageFullError(f"{full}; free some space (TMPDIR names the folder)") from error


def _chunks(file: IO[bytes]) -> Iterator[bytes]:
    with file:
        file.seek(0)
        while chunk := file.read(CHUNK_BYTES):
            yield chunk
