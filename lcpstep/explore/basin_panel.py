"""Basins of attraction on the page: computed when asked for, in a thread; a click starts a motion."""

from __future__ import annotations

import html
import threading
import time
from typing import Any

import numpy as np
from bokeh.events import Tap
from bokeh.models import Button, ColumnDataSource, Div
from bokeh.plotting import figure

from lcpstep.errors import LcpStepError
from lcpstep.explore.views import rectangle

SIDE, WIDTH, HEIGHT = 300, 480, 300  # pixels
REFRESH = 100  # of what is said of a basin that is computed [ms]
SHADES = 20  # colours of attractors, after which they repeat


class BasinPanel:
    """The figure, the button, and what is said of them.

    Parameters
    ----------
    page : whose session is computed, and whose motion a click starts
    document : Bokeh's, which calls back from other threads
    """

    def __init__(self, page: Any, document: Any) -> None:
        self.page, self.document = page, document
        self.image = ColumnDataSource({key: [] for key in ("image", "x", "y", "dw", "dh")})
        labels = page.session.scene().labels
        self.figure = figure(
            x_axis_label=labels[0], y_axis_label=labels[1], title="basins: click to start there", name="basin",
            width=WIDTH, height=HEIGHT,
        )  # fmt: skip
        self.figure.toolbar.logo = None
        self.figure.image_rgba("image", "x", "y", "dw", "dh", source=self.image)
        self.figure.scatter("q", "v", source=page.start, size=9, color="black", marker="x", line_width=2)
        self.figure.on_event(Tap, lambda event: page.begin_at(event.x, event.y))
        self.button = Button(label="basins of attraction", width=SIDE - 20, name="compute")
        self.button.on_click(self.compute)
        self.words = Div(text="the button computes the basins", width=WIDTH, name="attractors")
        self.of: dict[str, Any] | None = None  # parameters of the basin that is shown
        self.share, self.begun = 0.0, 0.0
        self.found: Any = None

    def compute(self) -> None:
        """Begin; a second click while one is computed is ignored."""
        if self.button.disabled or self.page.last is None:
            return
        self.button.disabled = True
        self.of, self.found, self.share, self.begun = dict(self.page.session.values), None, 0.0, time.time()
        low, high = rectangle(self.page.last)
        session = self.page.session

        def progress(done: int, total: int) -> None:
            self.share = done / max(total, 1)

        def work() -> None:
            try:
                self.found = session.basin(low, high, progress)
            except (LcpStepError, ValueError) as error:
                self.found = error

        threading.Thread(target=work, daemon=True).start()
        self.ticking = self.document.add_periodic_callback(self._tick, REFRESH)

    def forget_if_other(self, values: dict[str, Any]) -> None:
        """A basin of other parameters than these is not shown."""
        if self.of is not None and self.of != values:
            self.of = None
            self.image.data = {key: [] for key in ("image", "x", "y", "dw", "dh")}
            self.words.text = "the button computes the basins"

    def _tick(self) -> None:
        """Say how far it is; draw it when it is there."""
        used = time.time() - self.begun
        if self.found is None:
            left = f", {used * (1.0 / self.share - 1.0):.0f} s left of this part" if self.share > 0.0 else ""
            self.words.text = f"computing: {used:.1f} s{left}"
            return
        self.document.remove_periodic_callback(self.ticking)
        self.button.disabled = False
        if self.of is None:
            self.words.text = "the parameters have changed meanwhile; the button computes the basins"
        elif isinstance(self.found, Exception):
            self.words.text = html.escape(str(self.found))
        else:
            self._draw(self.found)

    def _draw(self, data: Any) -> None:
        pixels, colours = painted(data["label"].values)
        q, v = data["q"].values, data["v"].values
        (x, y), (dw, dh) = (q[0], v[0]), (np.ptp(q), np.ptp(v))
        self.image.data = {"image": [pixels], "x": [x], "y": [y], "dw": [dw], "dh": [dh]}
        rows = zip(data["name"].values, data["share"].values, data["share_error"].values, strict=True)
        self.words.text = "<br>".join(
            f'<span style="color:{colours[k % SHADES]}">&#9632;</span> {html.escape(str(name))}: '
            f"{share:.4f} &plusmn; {error:.4f}"
            for k, (name, share, error) in enumerate(rows)
        )


def painted(label: Any) -> tuple[Any, list[str]]:
    """(n_v, n_q) pixels as Bokeh takes them, white for no attractor, grey inside of obstacles; colours to name."""
    from matplotlib import colormaps
    from matplotlib.colors import to_hex

    shades = colormaps["tab20"](np.arange(SHADES))[:, :3]
    table = np.vstack([[0.6, 0.6, 0.6], [1.0, 1.0, 1.0], shades])
    index = np.where(label < 0, label + 2, 2 + np.mod(label, SHADES))
    rgba = np.full((*label.shape, 4), 255, dtype=np.uint8)
    rgba[..., :3] = np.round(255.0 * table[index])
    return rgba.view(np.uint32)[..., 0], [to_hex(c) for c in shades]
