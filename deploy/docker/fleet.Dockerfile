# topnav: the fleet process, with the core and its own extra and nothing else.
FROM python:3.11-slim-trixie

WORKDIR /app
COPY pyproject.toml constraints.txt LICENSE ./
# The core is the same layer in every image. The README belongs to the package and not to what runs.
RUN touch README.md && pip install --no-cache-dir --constraint constraints.txt . \
    && rm -r /usr/local/lib/python3.11/site-packages/numpy/*/tests
RUN pip install --no-cache-dir --constraint constraints.txt '.[fleet]'

COPY shared shared
COPY services/__init__.py services/__init__.py
COPY services/fleet services/fleet
# Nothing is written at run time: every start would compile anew otherwise.
RUN python -m compileall -q shared services

RUN groupadd --system --gid 10001 topnav \
    && useradd --system --uid 10001 --gid 10001 topnav
USER topnav
# The root file system is read-only: caches go to the tmpfs.
ENV HOME=/tmp PYTHONDONTWRITEBYTECODE=1 PYTHONUNBUFFERED=1
