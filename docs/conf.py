# The site that ./do docs builds: these pages by Sphinx, and a reference of the public headers by Doxygen.
import re

project = "pbnbrdf"
author = "The pbnbrdf authors"
copyright = author
extensions = ["myst_parser"]
html_theme = "furo"
html_title = "pbnbrdf"
html_show_copyright = False
html_show_sphinx = False
html_copy_source = False
exclude_patterns = ["Doxyfile"]


def name_files_of_the_sources(app, docname, source):
    """Links to files that aren't pages: the site has none of them, so it says where they are."""
    source[0] = re.sub(r"(?<!!)\[([^]]*)\]\(\.\./([^)]*)\)", r"\1 (`\2` in the sources)", source[0])


def setup(app):
    app.connect("source-read", name_files_of_the_sources)
