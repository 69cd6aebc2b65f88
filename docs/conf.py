"""Sphinx configuration. Some of the MyST pages are notebooks: `make docs` runs them and caches their outputs."""

import os
import sys
from hashlib import sha256
from pathlib import Path
from shutil import rmtree

os.environ.setdefault("TQDM_DISABLE", "1")  # no bars of progress in the pages
sys.path.insert(0, str(Path(__file__).parent / "_ext"))

from aolab import __version__, paths

project = "aolab"
author = "the aolab authors"
copyright = author
version = release = __version__

extensions = [
    "myst_nb",
    "sphinx.ext.autodoc",
    "sphinx.ext.extlinks",
    "sphinx_design",
    "docstrings",
    "kernels",
    "mathml",
    "tables",
]
exclude_patterns = ["_build", "_ext", "generated"]

# The pages' code computes their pictures and figures; none of them is in the repository. A page runs again if its cells
# or any source of the package have changed. There is no time limit: a busy machine is no error.
folders = (Path(paths.__file__).parent, paths.glsl(), paths.scenes())
sources = sorted(path for folder in folders for path in folder.rglob("*.*") if path.suffix != ".pyc")
caches = Path(__file__).parent / "_build" / "pages"
cache = caches / sha256(b"".join(path.read_bytes() for path in sources)).hexdigest()[:16]
for outdated in set(caches.glob("*")) - {cache}:
    rmtree(outdated)
nb_execution_cache_path = str(cache)
os.environ["AOLAB_CACHE"] = str(cache)  # the pages share their references, which go with the pages
nb_execution_mode = "cache"
nb_execution_timeout = -1
nb_execution_raise_on_error = True
nb_execution_show_tb = True
nb_merge_streams = True
nb_output_stderr = "warn"  # a warning or a notice in a cell is a mistake of the page; `-W` ends the build
nb_render_markdown_format = "myst"  # for tables

# Links that open a notebook elsewhere: only a workflow of GitHub has the address of the repository.
repository = os.environ.get("GITHUB_REPOSITORY", "OWNER/aolab")
if "GITHUB_REPOSITORY" in os.environ:
    tags.add("published")  # noqa: F821 - Sphinx defines it
extlinks = {
    "colab": (f"https://colab.research.google.com/github/{repository}/blob/main/examples/notebooks/%s.ipynb", "%s"),
    "binder": (f"https://mybinder.org/v2/gh/{repository}/main?urlpath=lab/tree/%s", "%s"),
}

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


def setup(app) -> None:
    """Without execution, the gallery has no pictures, which is no mistake."""
    app.connect(
        "config-inited",
        lambda _, config: config.nb_execution_mode == "off" and config.suppress_warnings.append("mystnb.glue"),
    )
