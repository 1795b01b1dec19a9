# `make demo` and `make test` do all the set-up: they need Python 3.11 and make, nothing else.
PYTHON ?= $(shell command -v python3.11 || command -v python3)
BIN := .venv/bin
export OPENBLAS_NUM_THREADS := 1
STUDIES := fig4 fig7 table2 readings load_cycles fig8 maps stationary

.PHONY: demo test bench docs paper clean

demo: .venv/.core      ## assess the paper's reference bridge, at a tolerance of 10 % (half the precision of the default)
	$(BIN)/hsictrl assess --tolerance 0.1 --processes 2

test: .venv/.tools     ## lint, types, walls, unit tests, doctests, documentation with its gallery and links
	$(BIN)/ruff check .
	$(BIN)/mypy
	$(BIN)/lint-imports
	MPLBACKEND=Agg $(BIN)/python -m pytest --numprocesses auto --dist loadfile
	$(BIN)/sphinx-build -q -W --keep-going docs docs/_build/html
	$(BIN)/python docs/links.py docs/_build/html

# each of the three tables goes into docs/benchmarks.json, from which the documentation takes it
bench: .venv/.tools    ## accuracy; ours, the host's road, and the ratio, on one thread; then studies, in two processes
	PYTHONPATH=. $(BIN)/python tests/benchmarks/accuracy.py
	$(BIN)/python tests/benchmarks/bench.py
	$(BIN)/python tests/benchmarks/studies.py

docs: .venv/.tools     ## the documentation, into docs/_build/html
	$(BIN)/sphinx-build -q -W docs docs/_build/html
	$(BIN)/python docs/links.py docs/_build/html

# ledgers of a run that was stopped are gone on with; delete them after a change of the code that a trial calls
paper: .venv/.tools    ## run the studies of the paper anew and replace their committed results
	for study in $(STUDIES); do \
		$(BIN)/hsictrl paper $$study --recompute --resume --processes 2 --output hsictrl/paper/results || exit 1; \
	done
	rm -f hsictrl/paper/results/*.ledger

.venv/.core: pyproject.toml
	$(PYTHON) -m venv .venv
	$(BIN)/pip install --quiet --disable-pip-version-check --editable .
	touch $@

.venv/.tools: .venv/.core
	$(BIN)/pip install --quiet --disable-pip-version-check --editable '.[test,docs]'
	touch $@

clean:
	rm -rf .venv docs/_build docs/reference docs/gallery
