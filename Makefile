# Two commands do all the set-up themselves: `make compare` and `make test`. They need Python 3.11 or later and make.
# To use an environment that is there already, give BIN=its/bin, and VENV=a directory with the stamps installed{,-dev}.
PYTHON ?= python3
VENV   := .venv
BIN    := $(VENV)/bin
# The systems are small and dense: threads inside LAPACK cost more than they bring.
export OPENBLAS_NUM_THREADS ?= 1
# Bytecode is kept in the environment, even where Python is told to write none: else each process compiles its imports.
# Another one given as BIN may have bytecode of its own, or be read only: there Python does as it does.
ifeq ($(BIN),$(VENV)/bin)
export PYTHONPYCACHEPREFIX ?= $(abspath $(VENV)/bytecode)
endif
unexport PYTHONDONTWRITEBYTECODE

.PHONY: help compare test check bench hard honesty atlas peers docs gallery clean

# Targets share the environment that they install.
.NOTPARALLEL:

help: ## show this list
	@sed -n 's/^\([a-z]*\):.*## /\1\t/p' $(MAKEFILE_LIST) | expand -t 10

compare: $(VENV)/installed ## compare both solvers at six Tabor parameters
	$(BIN)/fem-adhesion compare

test: $(VENV)/installed-dev ## run the test suite
	$(BIN)/python -m pytest --numprocesses auto --dist loadfile --no-loadscope-reorder

check: $(VENV)/installed-dev ## check format, style and types
	$(BIN)/ruff format --check .
	$(BIN)/ruff check .
	$(BIN)/mypy

bench: $(VENV)/installed-dev ## time the solvers beside a yardstick (some minutes; QUICK=1: some seconds)
	QUICK=$(QUICK) $(BIN)/python -m pytest tests/benchmarks --benchmark-only --benchmark-enable --benchmark-columns=min,median,rounds -q

hard: $(VENV)/installed-dev ## attempt the hard cases and print how each ended (a minute; OUT=directory of the tables, hard)
	$(BIN)/python tests/estimates hard $(or $(OUT),hard)

honesty: $(VENV)/installed-dev ## hold error estimates against the truth, by families of scenes (QUICK=1: a minute; SEED=n)
	$(BIN)/python tests/estimates honesty $(if $(QUICK),--quick) $(if $(SEED),--seed $(SEED))

atlas: $(VENV)/installed ## make the files of the atlas anew (half an hour; CHECK=n: compare them with n new curves instead)
	$(BIN)/python -m halfspace.atlas $(if $(CHECK),--check $(CHECK))
	$(BIN)/python -m fem_adhesion.finite_sphere.atlas $(if $(CHECK),--check $(CHECK))

PEERS := adhesion tamaas ngsolve
peers: $(PEERS:%=build/peers/%/installed) $(VENV)/installed ## grade other codes, each in an environment of its own (some minutes; OUT=directory of the table, peers)
	rm -rf build/peers/runs
	build/peers/adhesion/bin/python tests/peers/with_maugis.py build/peers/runs
	set -e; for peer in $(PEERS); do OMP_NUM_THREADS=1 build/peers/$$peer/bin/python -W ignore tests/peers/with_$$peer.py build/peers/runs; done
	$(BIN)/python tests/peers/with_halfspace.py build/peers/runs
	$(BIN)/python tests/peers/table.py build/peers/runs $(or $(OUT),peers)
	cp $(or $(OUT),peers)/peers.csv tests/peers

build/peers/%/installed: tests/peers/requirements/%.txt
	$(PYTHON) -m venv $(@D)
	$(@D)/bin/python -m pip install --quiet --disable-pip-version-check --requirement $<
	@touch $@

docs: $(VENV)/installed-dev ## build the documentation into build/docs, with every script of the gallery run (two minutes)
	rm -rf docs/generated $(or $(OUT),build/docs)
	$(BIN)/python -m sphinx --builder html --nitpicky --fail-on-warning --keep-going --quiet docs $(or $(OUT),build/docs)
	@echo "written: $(or $(OUT),build/docs)/index.html"

gallery: $(VENV)/installed-dev ## draw kept pictures anew if the code that draws them has changed (ALL=1: all, two minutes)
	$(BIN)/python docs/pictures/make.py $(if $(ALL),--all)

clean: ## remove the environment and all caches
	rm -rf $(VENV) build docs/generated *.egg-info .pytest_cache .mypy_cache .ruff_cache .hypothesis .benchmarks .import_linter_cache

# One call installs all that a target needs. What is compiled is what is imported, and that by Python, when it is.
define install
$(PYTHON) -m venv $(VENV)
$(BIN)/python -m pip install --quiet --disable-pip-version-check --no-compile --constraint constraints.txt --editable '.[$(1)]'
endef

$(VENV)/installed: pyproject.toml constraints.txt
	$(call install,studies)
	@touch $@

$(VENV)/installed-dev: pyproject.toml constraints.txt
	$(call install,dev)
	@touch $(VENV)/installed $@
