# Everything runs from a bare clone: `setup` makes .venv and installs all that a run needs.
#   make demo    explore the apartment, then find a hidden robot from its picture (KEEP=1 leaves it running)
#   make ros-demo  the same with a robot that only ROS 2 reaches, in real time: about ten minutes
#   make test    every test but those of tests/faults      make check   lint, types, unit tests: two minutes
#                (WORKERS=0: in one process)
#   make containers  the same stack by Docker Compose, as a newcomer runs it
#   make docs    the documentation site, into runs/site (to write it: mkdocs serve --config-file deploy/site/mkdocs.yml)
#   make faults  what dies, hangs, lies, floods or is cut off: deploy/FAULTS.md
PYTHON ?= python3
VENV ?= .venv
KEEP ?=
PYTEST_ARGS ?=
# Most tests wait for processes: twice as many workers as the smallest machine has cores. 0: in one process.
WORKERS ?= 4
# The matrices are small: more threads only wait for each other, and tests run side by side.
export OPENBLAS_NUM_THREADS = 1
# Workers share the cores: each with as many threads as there are cores costs a fifth more.
test check: export OMP_NUM_THREADS = 1
test check: export OPENCV_FOR_THREADS_NUM = 1
# Hundreds of processes start in a run of the tests: without bytecode on disk each compiles for two seconds.
unexport PYTHONDONTWRITEBYTECODE
NOT_IN_TEST := --ignore=tests/faults --ignore=tests/benchmarks
FUZZ_ARGS ?= --seconds 60 --json runs/fuzz/report.json

BIN := $(VENV)/bin
STAMP := $(VENV)/.installed
INPUTS := pyproject.toml experiments/pyproject.toml constraints.txt deploy/packaging/opencv-shim/pyproject.toml
SOURCES := services shared simulator experiments tests

.PHONY: setup demo ros-demo test faults check lint types containers bench fuzz sbom audit screenshots docs clean

setup: $(STAMP)
	@bash deploy/setup/vulkan.sh

$(STAMP): $(INPUTS)
	@bash deploy/setup/venv.sh "$(PYTHON)" "$(VENV)"
	@# --no-compile: a run imports a small part of torch and sympy; compiling all of it doubles the time.
	$(BIN)/python -m pip install --quiet --no-compile --constraint constraints.txt \
		./deploy/packaging/opencv-shim --editable '.[dev]' --editable ./experiments
	$(BIN)/python -m pip check
	@touch $@

demo: setup
	KEEP=$(KEEP) $(BIN)/topnav demo

ros-demo: setup
	@bash deploy/setup/ros.sh $(BIN)/python .venv-ros
	bash deploy/setup/own_network.sh $(BIN)/topnav ros-demo

test: setup
	@bash deploy/setup/test_programs.sh
	@# All workers begin at once and would each compile every test: a minute of two cores.
	@$(BIN)/python -m pytest --collect-only -qq $(NOT_IN_TEST) >/dev/null 2>&1 & \
		bash deploy/setup/ros.sh $(BIN)/python .venv-ros || echo "No Python with ROS: the tests that need it are skipped." >&2; wait
	$(BIN)/python -m pytest -n $(WORKERS) $(NOT_IN_TEST) $(PYTEST_ARGS)

faults: setup
	$(BIN)/python -m pytest tests/faults $(PYTEST_ARGS)

check: setup lint types
	$(BIN)/python -m pytest -n $(WORKERS) tests/unit tests/test_architecture.py tests/test_rooms.py \
		-m "not render and not slow" $(PYTEST_ARGS)

lint: setup
	$(BIN)/ruff check $(SOURCES)
	$(BIN)/ruff format --check $(SOURCES)

types: setup
	$(BIN)/mypy

containers:
	@bash deploy/setup/containers.sh

bench: setup
	$(BIN)/topnav bench loop --json runs/bench/loop.json
	$(BIN)/topnav bench loop --real-time --json runs/bench/loop-real-time.json
	$(BIN)/topnav study scale --json runs/bench/scale.json --plot runs/bench/scale.png
	$(BIN)/python -m pytest -q -s tests/benchmarks/test_console_graph.py tests/benchmarks/test_rendering.py
	$(BIN)/python -m pytest -q -s tests/benchmarks/test_gateway_load.py tests/benchmarks/test_secured_bus.py \
		tests/benchmarks/test_map_store_databases.py tests/benchmarks/test_late_feature_service.py \
		tests/benchmarks/test_two_view_effort.py

fuzz: setup
	$(BIN)/python -m tests.fuzz $(FUZZ_ARGS)

sbom: setup
	@bash deploy/setup/audit.sh sbom $(VENV)

audit: setup
	@bash deploy/setup/audit.sh audit $(VENV)

screenshots: setup
	$(BIN)/python -m tests.screenshots

docs: setup
	NO_MKDOCS_2_WARNING=1 $(BIN)/mkdocs build --strict --quiet --config-file deploy/site/mkdocs.yml

clean:
	rm -rf $(VENV) build dist .mypy_cache .ruff_cache .pytest_cache .hypothesis
	find $(wildcard $(SOURCES)) -name __pycache__ -type d -prune -exec rm -rf {} +
