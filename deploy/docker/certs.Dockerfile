# topnav: the one-shot that makes certificates, with the core and its own extra and nothing else.
FROM python:3.11-slim-trixie

WORKDIR /app
COPY pyproject.toml constraints.txt LICENSE ./
# The core is the same layer in every image. The README belongs to the package and not to what runs.
RUN touch README.md && pip install --no-cache-dir --constraint constraints.txt . \
    && rm -r /usr/local/lib/python3.11/site-packages/numpy/*/tests
RUN pip install --no-cache-dir --constraint constraints.txt '.[certs]'

COPY shared shared
# Nothing is written at run time: every start would compile anew otherwise.
RUN python -m compileall -q shared

# An empty volume takes the owner of the folder it covers: all services run as the same user.
RUN groupadd --system --gid 10001 topnav \
    && useradd --system --uid 10001 --gid 10001 topnav \
    && for one in authority router ros simulator camera features signs map_store planner drive dispatch fleet \
        gateway recorder foxglove operator viewer; do install --directory --owner topnav --mode 700 "/certs/$one"; done
USER topnav
# The root file system is read-only: caches go to the tmpfs.
ENV HOME=/tmp PYTHONDONTWRITEBYTECODE=1 PYTHONUNBUFFERED=1
