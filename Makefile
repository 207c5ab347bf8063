# Every target that needs the environment makes it first, from the pinned and hashed requirements.lock.

PYTHON ?= python3
STUDY ?= families/measured.toml

# make itself predefines WEAVE (for CWEB), so that ?= would never apply
ifeq ($(origin WEAVE),default)
WEAVE := twill32
endif
OPTIONS ?=
BIN := .venv/bin
READY := .venv/.ready

.DEFAULT_GOAL := help

.PHONY: help
help: ## show this help
	@echo "usage: make TARGET [NAME=VALUE ...]"
	@awk -F ':.*## ' '/^[a-z-]+:.*## / { printf "  %-14s%s\n", $$1, $$2 }' $(MAKEFILE_LIST)
	@echo "e.g.   make cell WEAVE=satin8 OPTIONS='--through 4'"

$(READY): requirements.lock
	@$(PYTHON) -c 'import sys; sys.exit(sys.version_info < (3, 11))' || \
		{ echo "fabric-cad needs Python 3.11 or later; name one with PYTHON=..."; exit 1; }
	@echo "installing the environment into .venv (once, about 2 GB) ..."
	@$(PYTHON) -m venv --clear .venv
	@$(BIN)/python -m pip install -q --disable-pip-version-check --require-hashes -r requirements.lock
	@$(BIN)/python -m pip install -q --disable-pip-version-check --no-deps --no-build-isolation -e .
	@touch $@

.PHONY: install
install: $(READY) ## make the environment .venv

.PHONY: cell
cell: $(READY) ## WEAVE=row: STEP, mesh, deck, picture and report of one row in build/<row>
	@$(BIN)/fabric-cad cell $(WEAVE) $(OPTIONS)

.PHONY: composite
composite: $(READY) ## WEAVE=row: its composite cell, with a matrix of hexahedra between the yarns, in build/<row>
	@$(BIN)/fabric-cad composite $(WEAVE) $(OPTIONS)

.PHONY: tension
tension: $(READY) ## WEAVE=row: biaxial tension of its cell (needs CalculiX: ccx)
	@$(BIN)/fabric-cad tension $(WEAVE) $(OPTIONS)

.PHONY: shear
shear: $(READY) ## WEAVE=row: in-plane shear of its cell (needs CalculiX: ccx)
	@$(BIN)/fabric-cad shear $(WEAVE) $(OPTIONS)

.PHONY: stiffness
stiffness: $(READY) ## WEAVE=row: homogenised stiffness of its composite (OPTIONS=--plate: A, B, D)
	@$(BIN)/fabric-cad stiffness $(WEAVE) $(OPTIONS)

.PHONY: voxels
voxels: $(READY) ## WEAVE=row: its composite on a regular grid (OPTIONS='--cells 200x200x60')
	@$(BIN)/fabric-cad voxels $(WEAVE) $(OPTIONS)

.PHONY: permeability
permeability: $(READY) ## WEAVE=row: how a fluid flows between its yarns (OPTIONS=--margin-study)
	@$(BIN)/fabric-cad permeability $(WEAVE) $(OPTIONS)

.PHONY: show
show: $(READY) ## WEAVE=row: the same cell in an interactive window
	@$(BIN)/fabric-cad show $(WEAVE)

.PHONY: design
design: $(READY) ## WEAVE=row: a page in the browser that draws the fabric while its numbers change
	@$(BIN)/fabric-cad design $(WEAVE) $(OPTIONS)

.PHONY: page
page: $(READY) ## WEAVE=row: its cell as one HTML file to look at, build/<row>/page.html
	@$(BIN)/fabric-cad page $(WEAVE)

.PHONY: gallery
gallery: $(READY) ## every row as an HTML file, and an index of them, in build/gallery
	@$(BIN)/fabric-cad page --gallery

.PHONY: list
list: $(READY) ## every row of the family tables
	@$(BIN)/fabric-cad list

.PHONY: families
families: $(READY) ## solve every row of every table into build/families/<family>.csv
	@$(BIN)/fabric-cad solve

.PHONY: validate
validate: $(READY) ## measured against model, standard deviations propagated
	@$(BIN)/fabric-cad validate

.PHONY: study
study: $(READY) ## STUDY=file.toml: a study of many fabrics into build/<file>; again: goes on where it stopped
	@$(BIN)/fabric-cad study $(STUDY) $(OPTIONS)

.PHONY: test
test: $(READY) ## run the tests
	@$(BIN)/python -m pytest -n 2 --dist loadfile

.PHONY: lint
lint: $(READY) ## check the sources
	@$(BIN)/ruff check -q fabric_cad tests
	@$(BIN)/ruff format -q --check fabric_cad tests
	@$(BIN)/python -m mypy --no-error-summary

.PHONY: coverage
coverage: $(READY) ## run the tests and tell which lines they reach: terminal, build/coverage/index.html
	@mkdir -p build
	@$(BIN)/python -m pytest -n 2 --dist loadfile --cov=fabric_cad --cov-report=term --cov-report=html:build/coverage

.PHONY: docs
docs: $(READY) ## build the documentation into build/docs; a warning is an error
	@$(BIN)/python -m sphinx -q -W --keep-going -b html -d build/.doctrees docs build/docs
	@$(BIN)/fabric-cad page --gallery -q --out build/docs
	@$(BIN)/python tests/links.py build/docs
	@echo build/docs/index.html

.PHONY: notebooks
notebooks: $(READY) ## run the notebooks and store them with their outputs
	@$(BIN)/python tests/notebooks.py

.PHONY: stability
stability: $(READY) ## random fabrics through CAD and mesh, or filled with matrix (PART=narrow SEEDS=0-50)
	@$(BIN)/python tests/stability.py $(PART:%=--part %) $(SEEDS:%=--seeds %)

.PHONY: fuzz
fuzz: $(READY) ## broken tables, TOML, drafts and command lines, kills, two runs at once (PART=tables SEEDS=0-50)
	@$(BIN)/python tests/fuzz.py $(PART:%=--part %) $(SEEDS:%=--seeds %)

.PHONY: bench
bench: $(READY) ## time and memory of every stage, as one table
	@$(BIN)/python tests/bench.py

.PHONY: bench-compare
bench-compare: $(READY) ## A=run.json B=run.json: two runs of bench side by side (default: the last two)
	@$(BIN)/python tests/bench.py --compare $(A) $(B)

.PHONY: golden
golden: $(READY) ## rewrite the golden decks of the tests
	@$(BIN)/python -m pytest -n 0 tests/decks --rewrite-golden

.PHONY: lock
lock: ## renew requirements.lock from pyproject.toml (needs uv)
	@uv pip compile pyproject.toml --extra dev --extra study --universal --python-version 3.11 --generate-hashes \
		--no-header --no-annotate --no-emit-index-url --no-emit-find-links -q -o requirements.lock

.PHONY: clean
clean: ## remove results (build); keeps .venv
	@rm -rf build docs/notebooks
