"""Sphinx: MyST pages, of which some are notebooks that run when the documentation is built. `make docs` builds it."""

import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parent / "_ext"))

from aolab import __version__

project = "aolab"
author = "the aolab authors"
copyright = author
version = release = __version__

extensions = ["myst_nb", "sphinx.ext.autodoc", "docstrings", "mathml", "tables"]
exclude_patterns = ["_build", "_ext", "generated"]

# Pictures and figures are made here and now, by the code that stands above them; none is kept in the repository.
nb_execution_mode = "auto"
nb_execution_timeout = 120
nb_execution_raise_on_error = True
nb_execution_show_tb = True
nb_merge_streams = True
nb_render_markdown_format = "myst"  # for tables

myst_enable_extensions = ["amsmath", "colon_fence", "deflist", "dollarmath"]
myst_heading_anchors = 3

default_role = "code"  # the docstrings' `single` backticks
autodoc_member_order = "bysource"
autodoc_typehints = "signature"
maximum_signature_line_length = 88

html_theme = "furo"
html_title = f"aolab {release}"
html_static_path = ["_static"]
html_css_files = ["aolab.css"]
html_show_copyright = False
html_math_renderer = "mathml"
