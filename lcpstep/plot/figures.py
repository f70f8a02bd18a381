"""A figure that a notebook shows: matplotlib's own does so only where `pyplot` was loaded before."""

from __future__ import annotations

import io

import matplotlib.figure


class Figure(matplotlib.figure.Figure):
    """As matplotlib's, and a picture at the end of a notebook's cell."""

    def _repr_png_(self) -> bytes:
        """What a notebook shows."""
        picture = io.BytesIO()
        self.savefig(picture, format="png")
        return picture.getvalue()
