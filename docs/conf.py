"""Sphinx configuration. The site needs no network: neither to build, nor to read."""

import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parent / "_ext"))

import flexbase

project = "flexbase"
author = "The flexbase developers"
project_copyright = "2026, The flexbase developers"
release = version = flexbase.__version__

extensions = ["myst_parser", "sphinx.ext.autodoc", "plain_docstrings", "mathml"]
myst_enable_extensions = ["dollarmath", "deflist"]
myst_heading_anchors = 3
exclude_patterns = ["_build"]
highlight_language = "text"
smartquotes = False

autodoc_member_order = "bysource"
autodoc_typehints_format = "short"
python_use_unqualified_type_names = True
python_maximum_signature_line_length = 90

html_theme = "furo"
html_title = f"flexbase {release}"
html_static_path = ["_static"]
html_css_files = ["flexbase.css"]
html_show_sphinx = False
