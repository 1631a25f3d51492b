# Everything runs from a bare clone: `setup` makes .venv and installs all that a run needs.
#   make demo    explore the apartment, then find a hidden robot from its picture (KEEP=1 leaves it running)
#   make test    every test          make check   lint, types and unit tests, within a minute
PYTHON ?= python3
VENV ?= .venv
KEEP ?=
PYTEST_ARGS ?=

BIN := $(VENV)/bin
STAMP := $(VENV)/.installed
INPUTS := pyproject.toml constraints.txt deploy/packaging/opencv-shim/pyproject.toml
SOURCES := services shared simulator experiments tests

.PHONY: setup demo test check lint types bench screenshots clean

setup: $(STAMP)
	@bash deploy/setup/vulkan.sh

$(STAMP): $(INPUTS)
	@bash deploy/setup/venv.sh "$(PYTHON)" "$(VENV)"
	@# --no-compile: a run imports a small part of torch and sympy; compiling all of it doubles the time.
	$(BIN)/python -m pip install --quiet --no-compile --constraint constraints.txt \
		./deploy/packaging/opencv-shim --editable '.[dev]'
	$(BIN)/python -m pip check
	@touch $@

demo: setup
	KEEP=$(KEEP) $(BIN)/topnav demo

test: setup
	$(BIN)/python -m pytest $(PYTEST_ARGS)

check: setup lint types
	$(BIN)/python -m pytest tests/unit tests/test_architecture.py -m "not render and not slow" $(PYTEST_ARGS)

lint: setup
	$(BIN)/ruff check $(SOURCES)
	$(BIN)/ruff format --check $(SOURCES)

types: setup
	$(BIN)/mypy

bench: setup
	$(BIN)/topnav bench loop
	$(BIN)/python -m pytest -q -s tests/benchmarks/test_console_graph.py

screenshots: setup
	$(BIN)/python -m tests.screenshots

clean:
	rm -rf $(VENV) build dist .mypy_cache .ruff_cache .pytest_cache .hypothesis
	find $(wildcard $(SOURCES)) -name __pycache__ -type d -prune -exec rm -rf {} +
