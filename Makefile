PYTHON ?= python3
BIN := .venv/bin

.DEFAULT_GOAL := help
.PHONY: help run test oldest coverage memtest arm lint format schema scenes gallery docs peers cycles bench check clean fuzz

help: ## list what can be made
	@grep -E '^[a-z]+:.*##' $(MAKEFILE_LIST) | sed -E 's/:.*## /\t/' | expand -t 12

.venv/ready: pyproject.toml
	$(PYTHON) -m venv .venv
	$(BIN)/pip install --quiet --editable '.[dev]'
	touch $@

run: .venv/ready ## render an example scene to room.png
	$(BIN)/vtray --threads 2 --stats scenes/room.json room.png

test: .venv/ready ## run all tests, kernels compiled
	$(BIN)/pytest -n 2

oldest: ## run all tests with the oldest releases that pyproject.toml allows
	$(PYTHON) -m venv build/oldest
	build/oldest/bin/pip install --quiet uv
	build/oldest/bin/uv pip install --quiet --python build/oldest --resolution lowest-direct \
		--editable '.[test]' 'pyparsing>=3.2,<3.3'  # newer ones warn of what Matplotlib calls
	build/oldest/bin/pytest -n 2

coverage: .venv/ready ## run the tests without the compiler, and see that they reach 95 % of lines
	NUMBA_DISABLE_JIT=1 $(BIN)/pytest -n 2 -q --cov --cov-report=
	$(BIN)/coverage report

memtest: .venv/ready ## see that memory stays within bounds
	$(BIN)/pytest tests/whole/test_memory.py

fuzz: .venv/ready ## try to break vtray for five minutes; SECONDS=3600 for longer, SEED=N to repeat
	cd tests && PYTHONWARNINGS=ignore PYTHONPATH=reference ../$(BIN)/python -m fuzz --failures ../build/fuzz \
		--seconds $(or $(SECONDS),300) $(if $(SEED),--seed $(SEED))

arm: .venv/ready ## compare pictures with those of an emulated aarch64 machine; needs Debian
	$(BIN)/python tests/arm/compare.py

lint: .venv/ready ## check style, types, and what imports what
	$(BIN)/ruff check
	$(BIN)/ruff format --check
	$(BIN)/mypy
	$(BIN)/lint-imports

format: .venv/ready ## bring the sources into shape
	$(BIN)/ruff format
	$(BIN)/ruff check --fix

schema: .venv/ready ## write docs/scene.schema.json
	$(BIN)/python -m vtray.scene.files.schema > docs/scene.schema.json

scenes: .venv/ready ## make the example scenes and their pictures again
	$(BIN)/python scenes/make_scenes.py --render

gallery: .venv/ready ## make the pictures of the gallery and of the docs again
	$(BIN)/python examples/make_gallery.py
	$(BIN)/python tests/reference/pages.py

docs: .venv/ready ## build the site of the docs, build/site
	$(BIN)/mkdocs build --strict

peers: benchmarks/.venv/ready ## install Mitsuba and OVITO for the benchmarks, each some 200 MB

benchmarks/.venv/ready: benchmarks/peers/requirements.txt
	$(PYTHON) -m venv benchmarks/.venv
	benchmarks/.venv/bin/pip install --quiet -r benchmarks/peers/requirements.txt
	touch $@

cycles: benchmarks/.venv-cycles/ready ## install Cycles for the benchmarks, 400 MB; for Python 3.11

benchmarks/.venv-cycles/ready:
	$(PYTHON) -m venv benchmarks/.venv-cycles
	benchmarks/.venv-cycles/bin/pip install --quiet bpy
	touch $@

bench: .venv/ready ## measure, and write the tables of docs/benchmarks.md and README.md
	$(BIN)/pip install --quiet --editable '.[bench]'
	$(BIN)/python benchmarks/run.py

check: lint test coverage ## all that must pass before a change lands

clean: ## remove what was made
	rm -rf .venv benchmarks/.venv benchmarks/.venv-cycles build dist .coverage .hypothesis .pytest_cache .mypy_cache .ruff_cache
