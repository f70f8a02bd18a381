"""The documentation site: pages in Markdown, the reference from docstrings, a gallery of examples that are run.

sphinx-build -W --keep-going docs out/site                          the whole site
sphinx-build -W --keep-going -D plot_gallery=0 docs out/site        without running the examples
"""

import os
import sys
from pathlib import Path

HERE = Path(__file__).resolve().parent
ROOT = HERE.parent
sys.path[:0] = [str(ROOT), str(HERE / "site")]
os.environ["PYTHONPATH"] = os.pathsep.join(filter(None, (str(ROOT), os.environ.get("PYTHONPATH"))))

import pictures  # noqa: E402  (in docs/site)

import lcpstep  # noqa: E402

project = "lcpstep"
author = "the lcpstep developers"
copyright = f"the lcpstep developers, {lcpstep.__version__}"
release = lcpstep.__version__

extensions = [
    "myst_parser",
    "sphinx.ext.autodoc",
    "sphinx.ext.mathjax",
    "numpydoc",
    "sphinx_gallery.gen_gallery",
    "docstrings",
    "outside",
]
exclude_patterns = ["site"]
suppress_warnings = ["config.cache"]  # the gallery's settings hold functions
nitpicky = False

html_theme = "furo"
html_title = f"lcpstep {release}"
html_static_path = ["site/static"]
html_css_files = ["site.css"]
html_copy_source = False

myst_heading_anchors = 4
myst_enable_extensions = ["dollarmath", "colon_fence"]
default_role = "literal"
autodoc_member_order = "bysource"
autodoc_typehints = "none"
add_module_names = False
numpydoc_show_class_members = False
numpydoc_class_members_toctree = False

sphinx_gallery_conf = {
    "examples_dirs": str(ROOT / "examples"),
    "gallery_dirs": "gallery",
    "filename_pattern": r"\.py$",
    "within_subsection_order": "FileNameSortKey",
    "image_scrapers": (pictures.saved,),
    "reset_modules": (),
    "abort_on_example_error": True,
    "download_all_examples": False,
    "show_signature": False,
    "remove_config_comments": True,
    "min_reported_time": 1000,
    "write_computation_times": False,
    "capture_repr": (),
    "copyfile_regex": "",
}
