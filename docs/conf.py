"""The guide as a site: `.ci/site` gathers the sources and builds it."""

import os
import sys
from importlib.metadata import metadata
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parent))

project = "asperity"
author = "The asperity developers"
package = metadata("asperity")
version = release = package["Version"]
addresses = dict(address.split(", ") for address in package.get_all("Project-URL"))

extensions = [
    "myst_nb",  # Markdown, and notebooks that are executed
    "sphinx.ext.autodoc",  # the reference of the Python package
    "sphinx.ext.napoleon",  # of docstrings in the form of numpy
    "sphinx_copybutton",  # commands are there to be copied
    "sphinx_design",  # cards on the front page
    "elsewhere",  # pages that are kept elsewhere in the repository
]
myst_enable_extensions = ["colon_fence", "html_image"]
myst_heading_anchors = 3
default_role = "py:obj"

# a cell that fails, fails the build
nb_custom_formats = {".py": ["jupytext.reads", {"fmt": "py:percent"}]}
nb_execution_mode = "force"
nb_execution_raise_on_error = True
nb_execution_timeout = 120
nb_execution_in_temp = True
nb_merge_streams = True
nb_ipywidgets_js = {}
# pages show no progress
os.environ["TQDM_DISABLE"] = "1"
exclude_patterns = ["conf.py", "elsewhere.py", "pictures.py", "recipe_files.py"]

napoleon_use_ivar = True
autodoc_typehints = "none"
# the word shape in a type, which several classes have as an attribute
suppress_warnings = ["ref.python"]
autodoc_member_order = "bysource"

html_theme = "pydata_sphinx_theme"
html_title = f"asperity {version}"
templates_path = ["_templates"]
html_static_path = ["_static"]
html_css_files = ["asperity.css"]
html_copy_source = False
html_theme_options = {
    "navbar_align": "left",
    "navbar_persistent": ["search-button"],
    "icon_links": [{"name": "Repository", "url": addresses["Source Code"], "icon": "fa-brands fa-git-alt"}],
    "header_links_before_dropdown": 8,
    "show_toc_level": 2,
    "footer_start": ["copyright"],
    "footer_end": [],
    "secondary_sidebar_items": ["page-toc"],
    "navigation_with_keys": False,
}
html_sidebars = {page: [] for page in ["index", "start", "gallery", "rust"]}
project_copyright = f"{author}, MIT or Apache-2.0"
