# topnav: the features process, with the core and its own extra and nothing else.
FROM python:3.11-slim-trixie

WORKDIR /app
COPY pyproject.toml constraints.txt README.md LICENSE ./
# For the CPU build of torch: --build-arg PIP_EXTRA_INDEX_URL=https://download.pytorch.org/whl/cpu
ARG PIP_EXTRA_INDEX_URL=
RUN pip install --no-cache-dir --constraint constraints.txt '.[features]'

COPY shared shared
COPY services/__init__.py services/__init__.py
COPY services/features services/features

RUN useradd --system --uid 10001 topnav \
    && install --directory --owner topnav /var/lib/topnav/models
USER topnav
# The root file system is read-only: caches go to the tmpfs.
ENV HOME=/tmp PYTHONDONTWRITEBYTECODE=1 PYTHONUNBUFFERED=1
# The tmpfs is memory: places of large maps wait on the volume, 22 kB each, in files that go with the process.
ENV TMPDIR=/var/lib/topnav/models
