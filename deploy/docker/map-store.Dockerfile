# topnav: the map-store process, with the core, its own extra and the driver of PostgreSQL, and nothing else.
FROM python:3.11-slim-trixie

WORKDIR /app
COPY pyproject.toml constraints.txt README.md LICENSE ./
RUN pip install --no-cache-dir --constraint constraints.txt '.[map-store,postgres]'

COPY shared shared
COPY services/__init__.py services/__init__.py
COPY services/map_store services/map_store

RUN useradd --system --uid 10001 topnav \
    && install --directory --owner topnav /var/lib/topnav/maps
USER topnav
# The root file system is read-only: caches go to the tmpfs.
ENV HOME=/tmp PYTHONDONTWRITEBYTECODE=1 PYTHONUNBUFFERED=1
# The tmpfs is memory: an archive that is imported waits on the volume.
ENV TMPDIR=/var/lib/topnav/maps
