# Two commands: `make demo` and `make test`. Set-up goes into .venv/, once; it is done again when pyproject.toml changes.
PYTHON ?= python3
RUN := .venv/bin/python
RUNTIME := .venv/runtime.stamp
DEV := .venv/dev.stamp
DOCS := .venv/docs.stamp

# A stamp holds the checkout's path: the editable install names it, so a moved checkout is set up again.
$(shell grep -qxF "$$(pwd)" $(RUNTIME) 2>/dev/null || rm -f $(RUNTIME))

.NOTPARALLEL:
.PHONY: help demo test docs bench clean distclean

help:
	@echo 'make demo       set up, then render every module into out/demo.png'
	@echo 'make test       set up, then check format, lint, types and tests, on the full driver and on OpenGL 3.3'
	@echo 'make docs       build the documentation into docs/_build/html'
	@echo 'make bench      time every pass'
	@echo 'make clean      remove what was built; make distclean also removes .venv'
	@echo 'PYTHON=...      the Python (3.11 or newer) that .venv is made from'

demo: $(RUNTIME)
	$(RUN) examples/demo.py out/demo.png

test: $(DEV)
	$(RUN) -m ruff format --check
	$(RUN) -m ruff check
	PYRIGHT_PYTHON_IGNORE_WARNINGS=1 $(RUN) -m pyright
	$(RUN) -m pytest
	MESA_GL_VERSION_OVERRIDE=3.3 MESA_GLSL_VERSION_OVERRIDE=330 $(RUN) -m pytest -m 'not wheel'

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
$(RUNTIME): pyproject.toml tools/setup.py
	$(PYTHON) tools/setup.py runtime
	@pwd > $@

$(DEV): $(RUNTIME)
	$(PYTHON) tools/setup.py dev
	@pwd > $@

$(DOCS): $(RUNTIME)
	$(PYTHON) tools/setup.py docs
	@pwd > $@
