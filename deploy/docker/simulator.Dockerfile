# topnav: the simulator process, with the core and its own extra and nothing else.
FROM python:3.11-slim-trixie

# Debian 13's Mesa has VK_KHR_external_semaphore_fd in its software driver, which SAPIEN needs; libx11 is linked by SAPIEN.
RUN apt-get update \
    && apt-get install -y --no-install-recommends libvulkan1 libx11-6 mesa-vulkan-drivers \
    && rm -rf /var/lib/apt/lists/*

WORKDIR /app
COPY pyproject.toml constraints.txt LICENSE ./
# The core is the same layer in every image. The README belongs to the package and not to what runs.
RUN touch README.md && pip install --no-cache-dir --constraint constraints.txt . \
    && rm -r /usr/local/lib/python3.11/site-packages/numpy/*/tests
COPY deploy/packaging/opencv-shim deploy/packaging/opencv-shim
RUN pip install --no-cache-dir --constraint constraints.txt ./deploy/packaging/opencv-shim '.[simulator]'

COPY shared shared
COPY simulator simulator
# Nothing is written at run time, so the bytecode is made here: every start would compile anew otherwise.
RUN python -m compileall -q shared simulator

RUN groupadd --system --gid 10001 topnav \
    && useradd --system --uid 10001 --gid 10001 topnav \
    && install --directory --owner topnav /var/lib/topnav/simulator-cache /var/lib/topnav/robot-state
USER topnav
# The root file system is read-only: caches go to the tmpfs.
ENV HOME=/tmp PYTHONDONTWRITEBYTECODE=1 PYTHONUNBUFFERED=1
# Compiled shaders outlive the container, as textures and light do (SIMULATOR_CACHE_DIR).
ENV MESA_SHADER_CACHE_DIR=/var/lib/topnav/simulator-cache
