"""Links of the pages to files of the repository that are no pages: offered for download."""

import re
from pathlib import Path

LINK = re.compile(r"(?<!!)\[(?P<text>[^\]]*)\]\((?P<file>\.\./[^)#]+?)(?:#[^)]*)?\)")


def setup(app):
    """Called by Sphinx."""
    app.connect("source-read", rewrite)
    return {"parallel_read_safe": True}


def rewrite(app, page, source):
    """Replace Markdown links that leave docs/ by downloads of the file."""
    folder = (Path(app.srcdir) / page).parent

    def download(link):
        file = (folder / link["file"]).resolve()
        inside = file.is_relative_to(app.srcdir)
        text = link["text"].replace("`", "")
        return link[0] if inside else f"{{download}}`{text} <{link['file']}>`"

    source[0] = LINK.sub(download, source[0])
