# Two commands for a new user: `make demo` and `make test`. Both create .venv and need Python 3.11+, nothing else.
PYTHON ?= python3
VENV   ?= .venv
PINS   ?= -c requirements/tested.txt
BIN    := $(VENV)/bin
PIP    := $(BIN)/python -m pip install --quiet $(PINS)
PYTEST := $(BIN)/python -m pytest -n auto --dist loadfile
# pytest has a process on every core already; more threads of linear algebra only wait for each other.
export OPENBLAS_NUM_THREADS ?= 1

.PHONY: demo test test-slow test-all test-core test-other test-newest mutation lock lint docs bench clean

demo: $(VENV)/.core               ## reproduce the paper into out/paper
	$(BIN)/flexbase reproduce --out out/paper

test: lint                        ## linters, types, layers, tests, docs: what a change must pass, in five minutes
	$(PYTEST) -m "not slow"
	$(MAKE) --no-print-directory docs

test-slow: $(VENV)/.test          ## the rest of the tests
	$(PYTEST) -m slow

test-all: test test-slow          ## every test that there is

test-core: $(VENV)/.bare          ## in a VENV of its own: what runs without any extra, and what is said of the rest
	$(PYTEST) -m "not slow" --core

test-other: $(VENV)/.test         ## in a VENV of another PYTHON: the command line from end to end, and the compiler
	$(PYTEST) -m "not slow" tests/cli tests/core tests/trace tests/files

test-newest:                      ## the same as `test` with the newest versions of everything
	$(MAKE) --no-print-directory VENV=.venv-newest PINS= test

mutation: $(VENV)/.test           ## does a test fail for every wrong decision? MODULES="flexbase.sampled.judged ..."
	$(BIN)/python tests/mutation/run.py $(MODULES)

lock:                             ## after `test-newest`: what it tested is what is tested from now on
	{ head -1 requirements/tested.txt; .venv-newest/bin/python -m pip freeze --exclude-editable; } > out/tested.txt
	mv out/tested.txt requirements/tested.txt

lint: $(VENV)/.test
	$(BIN)/ruff check .
	$(BIN)/ruff format --check .
	$(BIN)/mypy
	$(BIN)/lint-imports

docs: $(VENV)/.test               ## out/docs/index.html, offline
	$(BIN)/sphinx-build -W --keep-going -q -b html docs out/docs

bench: $(VENV)/.test              ## ratios, not seconds; --save and --compare: see benchmarks/README.md
	$(BIN)/python benchmarks/run.py

$(VENV)/bin/python:
	$(PYTHON) -c 'import sys; sys.exit(sys.version_info < (3, 11) and "flexbase needs Python 3.11 or newer; this is " + sys.version.split()[0] + ". Name another: make PYTHON=python3.12")'
	$(PYTHON) -m venv $(VENV)

$(VENV)/.core: pyproject.toml | $(VENV)/bin/python
	$(PIP) --editable .
	touch $@

$(VENV)/.bare: pyproject.toml requirements/tested.txt | $(VENV)/bin/python
	$(PIP) --editable . pytest pytest-xdist hypothesis hatchling
	touch $@

$(VENV)/.test: pyproject.toml requirements/tested.txt | $(VENV)/bin/python
	$(PIP) --editable ".[test]"
	touch $@ $(VENV)/.core

clean:
	rm -rf .venv .venv-* $(VENV) out build dist
