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
extensions = ["myst_parser", "accessible", "formulas", "reference", "gallery"]
exclude_patterns = ["_build", "_ext"]
myst_enable_extensions = ["dollarmath", "deflist"]
myst_heading_anchors = 3
nitpicky = True
# links into the repository, from pages that are read there as well
myst_url_schemes = ["http", "https"]
suppress_warnings = ["myst.xref_missing"]
html_math_renderer = "mathml"
html_theme = "alabaster"
html_theme_options = {
    "description": "Derives, solves, certifies and typesets satellite optimal control",
    "fixed_sidebar": True,
    "font_family": "system-ui, sans-serif",
    "head_font_family": "system-ui, sans-serif",
    "page_width": "72rem",
}
html_static_path = ["_static"]
html_css_files = ["satsym.css"]
html_copy_source = False
html_show_sourcelink = False
html_last_updated_fmt = None
pygments_style = "bw"
