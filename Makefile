# Targets set up .venv by themselves; PYTHON chooses the interpreter.
PYTHON ?= python3
VENV := .venv
BIN := $(VENV)/bin
STAMP := $(VENV)/.installed

SOURCES := $(shell find api codec formats cli -name '*.py' -o -name '*.pyi' -o -name '*.npz' \
	-o -name '*.cpp' -o -name '*.hpp' -o -name py.typed | LC_ALL=C sort)
# Python files are links in the editable install: only a new file list needs a reinstall.
KERNELS := $(filter codec/kernels/%,$(SOURCES))

.PHONY: install demo test check stubs tables bench picture clean FORCE

install: $(STAMP)

$(BIN)/python:
	$(PYTHON) -m venv $(VENV)

# Rewritten only when the list of files differs, or when build/, which the install links to, is gone.
$(VENV)/files: FORCE | $(BIN)/python
	@test -d build || rm -f $@
	@echo '$(SOURCES)' | cmp -s - $@ || echo '$(SOURCES)' > $@
FORCE:

$(STAMP): $(VENV)/files $(KERNELS) pyproject.toml setup.py | $(BIN)/python
	$(BIN)/python -m pip install --quiet --disable-pip-version-check -e '.[test,check]'
	@$(BIN)/python -m compileall -q build  # what an install that is not editable does by itself
	@touch $@

demo: $(STAMP)
	@PATH="$(CURDIR)/$(BIN):$$PATH" sh samples/demo.sh

test: $(STAMP)
	$(BIN)/python -m pytest -n auto

check: $(STAMP)
	$(BIN)/ruff check .
	$(BIN)/ruff format --check .
	$(BIN)/mypy -p ebz

stubs: $(STAMP)
	$(BIN)/python -m nanobind.stubgen -q -m ebz.codec._kernels -o codec/_kernels.pyi

tables: $(STAMP)
	$(BIN)/python -m tests.format_tables

bench: $(STAMP)
	$(BIN)/python -m pip install --quiet --disable-pip-version-check -e '.[bench]'
	$(BIN)/python -m tests.bench.run --json build/bench.json $(BENCH)

# Of what the last `make bench` measured.
picture: $(STAMP)
	$(BIN)/python -m tests.bench.picture build/bench.json docs/size-speed.svg

clean:
	rm -rf $(VENV) build dist *.egg-info
