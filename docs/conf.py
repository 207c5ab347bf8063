"""Builds the documentation from the Markdown beside this file, the notebooks and the docstrings."""

import shutil
from pathlib import Path

import fabric_cad

HERE = Path(__file__).parent
NOTEBOOKS = HERE / "notebooks"

# the notebooks stand at the top of the repository; Sphinx reads what is below its own folder
shutil.rmtree(NOTEBOOKS, ignore_errors=True)
shutil.copytree(HERE.parent / "notebooks", NOTEBOOKS)

project = "fabric_cad"
author = "the fabric_cad contributors"
copyright = f"{author}, MIT licence"
version = release = fabric_cad.__version__

extensions = ["myst_nb", "sphinx.ext.autodoc", "sphinx.ext.viewcode", "sphinx_copybutton"]
exclude_patterns = ["conf.py"]

nb_execution_mode = "off"  # stored with their outputs, which the tests hold against a run
myst_enable_extensions = ["colon_fence", "deflist"]
myst_heading_anchors = 3

autodoc_member_order = "bysource"
autodoc_typehints = "signature"
autodoc_preserve_defaults = True

html_theme = "furo"
html_title = "fabric_cad"
