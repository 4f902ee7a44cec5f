# Each target sets up what it needs by itself; none needs another to have been run.
export OMP_NUM_THREADS ?= 1
export OPENBLAS_NUM_THREADS ?= 1
unexport PYTHONDONTWRITEBYTECODE  # without bytecode each of some hundred started programs compiles the product again
BIN := .venv/bin

.PHONY: demo test quick nightly docs benchmark designs setup check lock clean

demo: setup  ## the whole loop on the shipped hidden-effect case
	@$(BIN)/thermoscope demo --out out/demo

test: setup  ## every check (style, types, import contracts, tests); of the nightly tests the fifth whose turn it is
	@$(BIN)/python -m pytest --turn $$(cat tests/turn)

quick: setup  ## the tests without those marked heavy, which build machines of full size, diagnose, or start programs
	@$(BIN)/python -m pytest -m "not heavy and not nightly"

nightly: setup  ## the tests of wheel, browsers, full machines and rates, all of them
	@$(BIN)/python -m pytest -m nightly

docs: setup  ## the documentation as a site, in out/site
	@$(BIN)/mkdocs build --quiet

benchmark: setup  ## every benchmark at a small size, results in out/benchmarks; hours at full size: docs/benchmarks.md
	@mkdir -p out/benchmarks
	@for name in geometry field network rendering viewer first_comparison; do echo "== $$name"; $(BIN)/python benchmarks/$$name.py --json out/benchmarks/$$name.json || exit 1; done
	@echo "== condensation"; $(BIN)/python benchmarks/condensation.py series-dc-100kw --coarse --json out/benchmarks/condensation.json
	@echo "== robustness"; $(BIN)/python benchmarks/console/robustness.py --hits 1 --json out/benchmarks/robustness.json
	@echo "== diagnosis"; $(BIN)/python benchmarks/diagnosis.py --samples 400000 --json out/benchmarks/diagnosis.json
	@echo "== bands"; $(BIN)/python benchmarks/bands.py --kinds servo --count 2 --json out/benchmarks/bands.json
	@echo "== drawn_benches"; $(BIN)/python benchmarks/drawn/drawn_benches.py --cases 1 --json out/benchmarks/drawn_benches.json
	@echo "== hidden_effects"; $(BIN)/python benchmarks/hidden_effects.py --seeds dev --count 2 --classes nothing one --json out/benchmarks/hidden_effects.json

designs: setup  ## Pareto sets of the three cooling layouts of the first paper, in out/designs
	@$(MAKE) -j3 designs-air designs-jacket-one designs-jacket-two  # at once: no core waits for the last

designs-%:
	@$(BIN)/thermoscope use optimise series-dc-100kw-$* --limit winding=155 --torque 50 --out out/designs/$*

setup:
	@scripts/setup

check: setup  ## what this computer lacks, with the command that fixes it
	@$(BIN)/thermoscope check

lock: setup  ## refresh the locked dependencies from pyproject.toml
	@$(BIN)/uv pip compile pyproject.toml --universal --generate-hashes --extra cad --extra view --extra bench --extra oil --group dev --no-annotate --no-header --quiet -o requirements.lock

clean:
	rm -rf out .pytest_cache .mypy_cache .ruff_cache .hypothesis dist
