"""Sphinx configuration: builds offline, warnings are errors."""

import sys
from importlib.metadata import version as installed
from pathlib import Path

HERE = Path(__file__).parent
sys.path.insert(0, str(HERE / "_ext"))

project = "hsictrl"
author = "The hsictrl developers"
copyright = "2026, The hsictrl developers"
version = release = installed("hsictrl")

extensions = ["sphinx.ext.autodoc", "sphinx.ext.autosummary", "numpydoc", "myst_parser", "sphinx_gallery.gen_gallery",
              "benchmarks", "claims", "mathml"]
myst_enable_extensions = ["deflist", "dollarmath"]
myst_heading_anchors = 3
autosummary_generate = True
numpydoc_show_class_members = False
autodoc_typehints = "none"
nitpicky = True
html_math_renderer = "mathml"
templates_path = ["_templates"]
exclude_patterns = ["_build", "_templates"]

GALLERIES = [name for name in ("paper", "control", "exercises") if (HERE.parent / "examples" / name).is_dir()]
sphinx_gallery_conf = {
    "examples_dirs": [f"../examples/{name}" for name in GALLERIES],
    "gallery_dirs": [f"gallery/{name}" for name in GALLERIES],
    "filename_pattern": r"\.py$",
    "within_subsection_order": "FileNameSortKey",
    "capture_repr": (),
    "abort_on_example_error": True,
    "image_srcset": ["2x"],
    "download_all_examples": False,
    "show_memory": False,
    "show_signature": False,
    "write_computation_times": False,
}

html_theme = "furo"
html_title = "hsictrl"
pygments_dark_style = "github-dark"
html_static_path = ["_static"]
html_css_files = ["site.css"]
