# Two commands: `make demo` and `make test`. Set-up goes into .venv/, once; it is done again when pyproject.toml changes.
PYTHON ?= python3
RUN := .venv/bin/python
RUNTIME := .venv/runtime.stamp
DEV := .venv/dev.stamp
DOCS := .venv/docs.stamp

# the tests' processes; files with slow tests come first (tests/conftest.py), and the tests of a file stay together
WORKERS ?= $(shell n=$$(getconf _NPROCESSORS_ONLN); echo $$((n < 8 ? n : 8)))
PYTEST = $(RUN) -m pytest -n $(WORKERS) --dist loadscope --no-loadscope-reorder
# what OpenGL can change, as on macOS and with old drivers
GL33 := MESA_GL_VERSION_OVERRIDE=3.3 MESA_GLSL_VERSION_OVERRIDE=330
GL33_TESTS := tests/gl tests/modules/test_contract.py \
	$(patsubst %,tests/pipeline/test_%.py,filters joints lighting occluders reliefs shadows surfaces voxels)
LONG := long or wheel or browser

# what the papers' figures are made of, as one hash; `aolab/shell` is above `aolab/papers`, which cannot import it
FIGURES := aolab glsl scenes tests/papers ':!aolab/shell' ':!*/figures.hash'
FIGURES_HASH = git ls-files --cached --others --exclude-standard -- $(FIGURES) \
	| git hash-object --stdin-paths | git hash-object --stdin

# A stamp holds the checkout's path: the editable install names it, so a moved checkout is set up again.
MOVED := $(if $(filter $(shell pwd),$(shell cat $(RUNTIME) 2>/dev/null)),,moved)

.NOTPARALLEL:
.PHONY: moved help demo lint types full long gl33 quick test fuzz figures figures-if-changed docs bench clean distclean

help:
	@echo 'make demo       set up, then render every module into out/demo.png: 10 seconds after the set-up'
	@echo 'make quick      format, lint, and the tests that are not slow: 4 minutes on two cores'
	@echo 'make test       format, lint, types, all tests, those of OpenGL again limited to 3.3: 5 minutes on two cores'
	@echo 'make long       the long tests: programs, notebooks, a browser, clusters, exercises, the installed wheel: 8 minutes'
	@echo 'make figures    the figures and tables of the papers, and the claims they hold: 5 minutes on two cores'
	@echo 'make fuzz       load 900 damaged files of 18 kinds: 2 minutes'
	@echo 'make docs       build the documentation into docs/_build/html: 3 minutes, as it runs the cells; pages are cached'
	@echo 'make bench      time every pass: 1 minute'
	@echo 'make clean      remove the files that were built; make distclean also removes .venv'
	@echo 'PYTHON=...      the Python (3.11 or newer) that .venv is made from'
	@echo 'WORKERS=...     the number of test processes; by default one for each core, at most 8'

demo: $(RUNTIME)
	$(RUN) examples/demo.py out/demo.png

lint: $(DEV)
	$(RUN) -m ruff format --check
	$(RUN) -m ruff check

types: $(DEV)
	PYRIGHT_PYTHON_IGNORE_WARNINGS=1 $(RUN) -m pyright

full: $(DEV)
	$(PYTEST) -m 'not (figures or fuzz or $(LONG))'

long: $(DEV)
	$(PYTEST) -m '($(LONG)) and not figures'

gl33: $(DEV)
	$(GL33) $(PYTEST) -m 'not slow' $(GL33_TESTS)

quick: lint
	$(PYTEST) -m 'not (slow or figures or fuzz or wheel or browser)'

test: lint types full gl33

fuzz: $(DEV)
	$(PYTEST) -m fuzz

figures: $(DEV)
	$(PYTEST) -m figures
	@$(FIGURES_HASH) > tests/papers/figures.hash
	@echo 'commit tests/papers/figures.hash: it names the sources whose figures hold'

# .ci/run: the figures, unless their hash is committed
figures-if-changed: $(DEV)
	@$(FIGURES_HASH) | cmp -s - tests/papers/figures.hash && echo 'figures: unchanged' || $(MAKE) figures

docs: $(DOCS)
	$(RUN) -m sphinx -W --keep-going -b html docs docs/_build/html

bench: $(RUNTIME)
	.venv/bin/aolab bench

clean:
	rm -rf out build dist docs/_build docs/generated .pytest_cache .ruff_cache
	find . -name __pycache__ -not -path './.venv/*' -prune -exec rm -rf {} +

distclean: clean
	rm -rf .venv

# A stamp is written only after its set-up has finished, so an interrupted set-up is done again.
$(RUNTIME): pyproject.toml tools/setup.py $(MOVED)
	$(PYTHON) tools/setup.py runtime
	@pwd > $@

$(DEV): $(RUNTIME)
	$(PYTHON) tools/setup.py dev
	@pwd > $@

$(DOCS): $(RUNTIME)
	$(PYTHON) tools/setup.py docs
	@pwd > $@
