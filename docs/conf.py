"""How the documentation is built: `make docs`."""

import sys
from pathlib import Path

HERE = Path(__file__).parent
sys.path[:0] = [str(HERE / "_ext")]

from satsym import __version__  # noqa: E402

project = "satsym"
author = "satsym contributors"
copyright = "satsym contributors"
version = release = __version__
extensions = [
    "myst_parser",
    "sphinx.ext.autodoc",
    "sphinx.ext.napoleon",
    "accessible",
    "formulas",
    "reference",
    "work",
]
exclude_patterns = ["_build", "_ext"]
myst_enable_extensions = ["dollarmath", "deflist"]
myst_heading_anchors = 3
nitpicky = True
nitpick_ignore_regex = [("py:.*", ".*")]  # docstrings name what has no page here
python_use_unqualified_type_names = True
autodoc_member_order = "bysource"
autodoc_preserve_defaults = True
autodoc_typehints_format = "short"
toc_object_entries_show_parents = "hide"
# links into the repository, from pages that are read there as well
myst_url_schemes = ["http", "https"]
suppress_warnings = ["myst.xref_missing"]
html_math_renderer = "mathml"
smartquotes = False  # options keep their two hyphens, and TOML its straight quotes
html_theme = "furo"  # light or dark, as its reader's system is
html_title = f"satsym {version}"
html_static_path = ["_static"]
html_css_files = ["satsym.css"]
html_copy_source = False
html_show_sourcelink = False
html_last_updated_fmt = None
pygments_style, pygments_dark_style = "a11y-light", "a11y-dark"  # legible to all
