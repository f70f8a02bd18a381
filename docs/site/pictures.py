"""The pictures and films that an example writes, taken over into its page of the gallery."""

import shutil
from pathlib import Path

from sphinx_gallery.scrapers import figure_rst

KINDS = (".png", ".gif")


def saved(block, block_vars, gallery_conf):
    """Move what an example has written beside itself into the gallery; the text that shows it."""
    folder = Path(block_vars["src_file"]).parent
    found = []
    for file in sorted(x for x in folder.iterdir() if x.suffix in KINDS):
        place = Path(next(block_vars["image_path_iterator"])).with_suffix(file.suffix)
        shutil.move(file, place)
        found.append(str(place))
    return figure_rst(found, gallery_conf["src_dir"])
