"""Sphinx configuration: builds offline, warnings are errors."""

from importlib.metadata import version as installed

project = "hsictrl"
author = "The hsictrl developers"
copyright = "2026, The hsictrl developers"
version = release = installed("hsictrl")

extensions = ["sphinx.ext.autodoc", "sphinx.ext.autosummary", "numpydoc", "myst_parser"]
myst_enable_extensions = ["deflist"]
autosummary_generate = True
numpydoc_show_class_members = False
autodoc_typehints = "none"
templates_path = ["_templates"]
exclude_patterns = ["_build", "_templates"]
html_theme = "furo"
html_title = "hsictrl"
html_static_path: list[str] = []
