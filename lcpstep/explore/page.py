"""The page: sliders on the left, time series, state space, map of impacts and basins beside them."""

from __future__ import annotations

import html
from typing import Any

import numpy as np
from bokeh.events import Tap
from bokeh.layouts import column, gridplot, row
from bokeh.models import Button, ColumnDataSource, Div, InlineStyleSheet, Legend, LegendItem, Select, Slider
from bokeh.palettes import Category10_10
from bokeh.plotting import figure

from lagrangian import Scene
from lagrangian.labels import common_unit
from lcpstep.explore.basin_panel import BasinPanel
from lcpstep.explore.session import METHODS, Session, slider_range, sliding
from lcpstep.explore.views import curves, impact_labels, impact_map
from lcpstep.trajectory import Trajectory

SHOWN = 8  # coordinates that are drawn
SIDE, WIDTH, HEIGHT = 300, 480, 300  # pixels
MAY_SHRINK = InlineStyleSheet(css=":host { overflow-wrap: anywhere; }")


class Page:
    """Everything that one visitor sees; `roots` are the models of the document.

    Parameters
    ----------
    session : what is looked at
    parameters : of the scene, by name; numbers get a slider
    """

    def __init__(self, session: Session, parameters: dict[str, Any], document: Any) -> None:
        self.session, scene = session, session.scene()
        self.paths = ColumnDataSource({key: [] for key in ("t", "q", "v", "color", "name")})
        self.path = ColumnDataSource({key: [] for key in ("q", "v")})
        self.start = ColumnDataSource({key: [] for key in ("q", "v")})
        self.hits = ColumnDataSource({key: [] for key in ("x", "y", "color")})
        self.message = Div(width=SIDE, styles={"min-height": "5em"}, name="message", stylesheets=[MAY_SHRINK])
        self.last: Trajectory | None = None
        self.basin = BasinPanel(self, document) if scene.n_x == 2 and np.isfinite(scene.period) else None
        figures = self._figures(scene)
        self.roots = row(
            column(*self._controls(scene, parameters), width=SIDE),
            gridplot(figures, merge_tools=False, toolbar_options={"logo": None}),
        )
        self.update()

    def update(self) -> None:
        """Run the scene as it is set, and show it."""
        run = self.last = self.session.run()
        self.message.text = html.escape(self.session.message)
        if self.basin is not None:
            self.basin.forget_if_other(self.session.values)
        if run is not None:
            self._show(run)

    def begin_at(self, q: float, v: float) -> None:
        """Start the motion of the first coordinate there."""
        self.session.start = (q, v)
        self.update()

    def _show(self, run: Trajectory) -> None:
        c, n, labels = curves(run), min(run.scene.n_q, SHOWN), run.scene.labels
        self.paths.data = {
            "t": [c.t] * n,
            "q": [c.q[:, k] for k in range(n)],
            "v": [c.v[:, k] for k in range(n)],
            "color": [Category10_10[k] for k in range(n)],
            "name": [labels[k].partition(" [")[0] for k in range(n)],
        }
        self.path.data = {"q": c.q[:, 0], "v": c.v[:, 0]}
        self.start.data = {"q": run.q[:1, 0], "v": run.v[:1, 0]}
        x, y, contact = impact_map(run)
        self.hits.data = {"x": x, "y": y, "color": [Category10_10[k % 10] for k in contact]}

    def _figures(self, scene: Scene) -> list[list[Any]]:
        """Rows of figures."""
        labels, several = scene.labels, scene.n_q > 1
        unit, rate = (common_unit(x) for x in (labels[: scene.n_q], labels[scene.n_q :]))
        position = f"positions [{unit}]" if several and unit else "coordinates" if several else labels[0]
        velocity = f"velocities [{rate}]" if several and rate else "velocities" if several else labels[-1]
        over_time = [
            figure(x_axis_label="time t [s]", y_axis_label=label, title=f"{title} over time", name=title)
            for title, label in (("position", position), ("velocity", velocity))
        ]
        over_time[1].x_range = over_time[0].x_range
        for f, y in zip(over_time, ("q", "v"), strict=True):
            lines = f.multi_line("t", y, color="color", source=self.paths)
            if several:
                item = LegendItem(label={"field": "name"}, renderers=[lines])
                f.add_layout(Legend(items=[item], label_text_font_size="8pt"), "right")
        plane = figure(
            x_axis_label=labels[0], y_axis_label=labels[scene.n_q], name="plane",
            title="state space: click to start there",
        )  # fmt: skip
        plane.line("q", "v", source=self.path)
        plane.scatter("q", "v", source=self.start, size=9, color="black", marker="x", line_width=2)
        plane.on_event(Tap, lambda event: self.begin_at(event.x, event.y))
        x, y = impact_labels(scene)
        hits = figure(x_axis_label=x, y_axis_label=y, title="impacts", name="impacts")
        hits.scatter("x", "y", color="color", source=self.hits, size=4)
        for f in (*over_time, plane, hits):
            f.width, f.height, f.toolbar.logo = WIDTH, HEIGHT, None
        rows = [[over_time[0], plane], [over_time[1], hits]]
        return rows if self.basin is None else [*rows, [self.basin.figure, self.basin.words]]

    def _controls(self, scene: Scene, parameters: dict[str, Any]) -> list[Any]:
        """Sliders, method, span, buttons."""
        method = Select(title="method", value=self.session.method, options=list(METHODS), width=SIDE - 20)
        method.on_change("value", lambda _, old, new: self._set(method=new))
        span = scene.t_span[1] - scene.t_span[0]
        end = self._slider(
            "length of the motion [s]", span, (span / 100.0, 4.0 * span, span / 100.0), "t_end"
        )
        sliders = [
            self._slider(name, value, slider_range(value), name)
            for name, value in sliding(parameters).items()
        ]
        again = Button(label="start where the scene starts", width=SIDE - 20, name="again")
        again.on_click(lambda: self._set(start=None))
        title = Div(text=f"<b>{html.escape(scene.name)}</b>", width=SIDE)
        buttons = [again] if self.basin is None else [again, self.basin.button]
        return [title, method, end, *sliders, *buttons, self.message]

    def _slider(self, title: str, value: float, between: tuple[float, float, float], name: str) -> Slider:
        low, high, step = between
        slider = Slider(
            title=title, value=value, start=min(low, value), end=max(high, value), step=step, width=SIDE - 20,
            name=name, format="0[.]0000" if abs(step) >= 1e-4 else "0.00e+0",
        )  # fmt: skip

        def moved(_: str, old: float, new: float) -> None:
            if name == "t_end":
                self._set(t_end=float(new))
            else:
                self.session.values = {**self.session.values, name: type(value)(new)}
                self.update()

        slider.on_change("value_throttled", moved)
        return slider

    def _set(self, **what: Any) -> None:
        for name, value in what.items():
            setattr(self.session, name, value)
        self.update()
