# `make` alone lists the targets. Needs Python 3.11 or newer; another one: make demo PYTHON=python3.13
PYTHON ?= $(or $(shell command -v python3.11),python3)
VENV   := .venv
BIN    := $(VENV)/bin
PIP    := $(BIN)/python -m pip install -qq --disable-pip-version-check
# Many containers tell Python not to write bytecode; then every start would compile satsym anew.
COMPILE := $(BIN)/python -m compileall -q satsym generated
# Nor would pytest keep the tests as it rewrites them, which takes it longer than to collect them.
PYTEST := env -u PYTHONDONTWRITEBYTECODE $(BIN)/python -m pytest -n 2 --dist worksteal

# Each recipe says itself what the user needs to know; errors of the tools come through (pip -qq: errors only).
.SILENT:
.NOTPARALLEL:
.PHONY: help demo test test-whole test-versions test-processors parity lint format derive check-derive bench bench-returns bench-drift bench-audit bench-truth bench-optima bench-proof bench-batch bench-models docs check-pages clean

help:  ## list the targets
	grep -E '^[a-z-]+:.*##' $(MAKEFILE_LIST) | sed -E 's/:.*## /|/' | awk -F'|' '{printf "  make %-14s %s\n", $$1, $$2}'

demo: $(VENV)/installed  ## solve two shipped problems, with pictures, into results/
	for name in soft-return its-thesis; do \
	    echo; echo "satsym solve $$name --plot"; \
	    $(BIN)/satsym solve $$name --plot || exit $$?; \
	done
	echo; echo "Results and pictures:"; ls -1 results/soft-return/solve/* results/its-thesis/solve/* | sed 's/^/  /'

test: lint  ## check style and types, and run the tests (with a sample of the slow ones)
	$(PYTEST)

test-whole: lint  ## the same with all slow tests
	$(PYTEST) --whole

test-versions:  ## test with the oldest and the newest dependencies that pyproject.toml allows, in separate environments
	$(PYTHON) .ci/versions.py oldest newest

test-processors: $(VENV)/installed-dev  ## compare verdicts with those of other OpenBLAS and NumPy kernels (takes half an hour)
	$(BIN)/python -m tests.bench.processors

parity: $(VENV)/installed-dev  ## compare solutions with recorded ones (takes half an hour; ONLY="NAME ..." selects instances, CASES=DIR adds some)
	$(BIN)/python -m tests.bench.parity $(if $(CASES),--cases $(CASES)) $(if $(ONLY),--only $(ONLY))

lint: $(VENV)/installed-dev  ## check style, types and the layers of imports
	$(BIN)/ruff check --quiet
	$(BIN)/ruff format --check --quiet --diff || { echo "to apply this: make format"; exit 1; }
	# it ends with 2 where a worker did not start within ten seconds, as on a busy machine
	$(BIN)/mypy --no-error-summary || { [ $$? = 2 ] && $(BIN)/mypy --no-error-summary --num-workers 0; }
	PYTHONPATH=. $(BIN)/lint-imports --no-cache --no-logo > $(VENV)/lint-imports.log || { cat $(VENV)/lint-imports.log; exit 1; }
	echo "lint: clean"

format: $(VENV)/installed-dev  ## format the code with ruff
	$(BIN)/ruff check --quiet --fix-only
	$(BIN)/ruff format --quiet

derive: $(VENV)/installed-dev  ## write generated/ from derivations/, and docs/instances.md and type stubs from the code
	$(BIN)/satsym derive
	$(BIN)/python -m satsym.codegen.protocol
	$(BIN)/python -m satsym.report.terminal.keys

check-derive: $(VENV)/installed-dev  ## fail if generated/ differs from what derivations/ gives
	$(BIN)/satsym derive --check

bench: $(VENV)/installed-bench  ## compare the speed of satsym with that of other tools
	$(BIN)/python tests/bench/run.py

bench-returns: $(VENV)/installed-bench  ## solve 12,000 random returns to an orbit (takes hours)
	$(BIN)/python tests/bench/returns.py

bench-drift: $(VENV)/installed-bench  ## simulate orbits for 10,000 revolutions with each propagator (takes minutes)
	$(BIN)/python tests/bench/drift.py

bench-audit: $(VENV)/installed-dev  ## plant errors in printed formulas, and count how many are caught and named (takes minutes)
	$(BIN)/python -m tests.bench.audit

bench-truth: $(VENV)/installed-bench  ## compare random instances of all classes with independent solutions (takes hours)
	$(BIN)/python -m tests.bench.truth.run

bench-optima: $(VENV)/installed-bench  ## compare problems with known optima with a direct method (takes minutes)
	$(BIN)/python tests/bench/optima.py

bench-proof: $(VENV)/installed-dev  ## prove the shipped instances and 100 random extremals, and write docs/proved.md (takes minutes)
	$(BIN)/python -m tests.bench.proof

bench-batch: $(VENV)/installed-bench  ## compare solving many instances at once with loops in C, NumPy and CasADi (takes minutes; TABLES="1 5" selects tables)
	OPENBLAS_NUM_THREADS=1 OMP_NUM_THREADS=1 $(BIN)/python tests/bench/batch.py $(TABLES)

bench-models: $(VENV)/installed-dev  ## derive, generate and load 2,000 random models, and plant errors in them (takes hours)
	$(BIN)/python -m tests.bench.models --processes 2

docs: $(VENV)/installed-docs  ## build the documentation in docs/_build, with warnings as errors
	$(BIN)/python -m sphinx -q -W --keep-going -j auto docs docs/_build/html
	echo "docs/_build/html/index.html"

check-pages: $(VENV)/installed-pages docs  ## check the accessibility of the pages (axe, with the system's Chromium)
	$(BIN)/python .ci/pages.py

clean:  ## remove the environment, results and caches
	rm -rf $(VENV) results build docs/_build docs/_static/gallery docs/_static/figures docs/reference docs/gallery docs/gallery.md docs/notebook*.md *.egg-info .pytest_cache .ruff_cache .mypy_cache .hypothesis
	find . -name __pycache__ -type d -prune -exec rm -rf {} +

# One environment for everything, made again only when pyproject.toml changes.
$(VENV)/installed: pyproject.toml
	echo "Setting up $(VENV) (once) ..."
	$(PYTHON) -m venv $(VENV)
	$(PIP) --editable .
	$(COMPILE)
	touch $@

$(VENV)/installed-%: pyproject.toml
	echo "Setting up $(VENV) with the $* tools (once) ..."
	$(PYTHON) -m venv $(VENV)
	$(PIP) --editable '.[$*]'
	$(COMPILE)
	touch $(VENV)/installed $@
