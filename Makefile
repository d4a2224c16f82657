# Two commands for a new user: `make demo` and `make test`. Both create .venv and need Python 3.11+, nothing else.
PYTHON ?= python3
VENV   := .venv
BIN    := $(VENV)/bin

.PHONY: demo test check lint docs bench clean

demo: $(VENV)/.core               ## reproduce the paper into out/paper
	$(BIN)/flexbase reproduce --out out/paper

test: check                       ## everything that CI asks for

check: lint                       ## linters, types, layers, tests, docs
	$(BIN)/python -m pytest -n auto --dist loadfile
	$(MAKE) --no-print-directory docs

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
	$(BIN)/python -m pip install --quiet --editable .
	touch $@

$(VENV)/.test: pyproject.toml | $(VENV)/bin/python
	$(BIN)/python -m pip install --quiet --editable ".[test]"
	touch $@ $(VENV)/.core

clean:
	rm -rf $(VENV) out build dist
