"""A run at a glance, as HTML for notebooks: how it went, and its motion as a small picture in SVG.

The picture is a line of the lowest and highest values in each of its columns, so that no peak is lost; impacts are
marks below. It knows the kept states only.
"""

from __future__ import annotations

from html import escape
from typing import Any

import numpy as np
from numpy.typing import NDArray

from lcpstep.trajectory import Kind, Trajectory, blows

Array = NDArray[np.float64]
WIDTH, HEIGHT, COLUMNS = 240, 44, 240  # of the picture [px], and values along it
MARKS = 6  # height of the marks of impacts [px]
MOST = 3  # coordinates that are drawn


def html(run: Any) -> str:
    """A table with a row for each fact, and one picture for each of the first coordinates."""
    rows = [
        ("method", repr(run.method)),
        ("time", f"{run.t[0]:g} .. {run.t[-1]:g} s" if len(run.t) else "nothing kept"),
        ("ended", f"{run.status.name}: {run.message}"),
        ("kept", f"{len(run.t)} states of {run.counts.steps} steps"),
        (*_events(run),),
        *([("error bar", str(run.error))] if getattr(run, "error", None) else []),
    ]
    lines = [f"<tr><th>{escape(name)}</th><td>{escape(text)}</td></tr>" for name, text in rows]
    x = run.q if isinstance(run, Trajectory) else run.x
    labels = run.scene.labels
    for k in range(min(MOST, x.shape[1])):
        picture = sparkline(run.t, x[:, k], _marks(run))
        if picture:
            lines.append(f"<tr><th>{escape(str(labels[k]))}</th><td>{picture}</td></tr>")
    if x.shape[1] > MOST:
        lines.append(f"<tr><th></th><td>and {x.shape[1] - MOST} more</td></tr>")
    title = f"<caption><b>{escape(run.scene.name)}</b></caption>"
    return f'<table style="text-align:left">{title}{"".join(lines)}</table>'


def sparkline(t: Array, x: Array, marks: Array) -> str:
    """Values x over times t as SVG, and marks below; "" for fewer than two finite values."""
    known = np.isfinite(x)
    t, x = t[known], x[known]
    if len(t) < 2 or not t[-1] > t[0]:
        return ""
    across = WIDTH / (t[-1] - t[0])
    low, high = float(np.min(x)), float(np.max(x))
    up = (HEIGHT - MARKS - 4) / (high - low or 1.0)
    column = np.minimum(((t - t[0]) * across * COLUMNS / WIDTH).astype(int), COLUMNS - 1)
    chosen: list[int] = []
    for part in np.split(np.arange(len(t)), np.flatnonzero(np.diff(column)) + 1):
        ends = {int(part[0]), int(part[-1]), int(part[np.argmin(x[part])]), int(part[np.argmax(x[part])])}
        chosen += sorted(ends)
    points = " ".join(f"{(t[i] - t[0]) * across:.1f},{2 + (high - x[i]) * up:.1f}" for i in chosen)
    places = sorted({round(float((m - t[0]) * across), 1) for m in marks})
    ticks = "".join(f"M{at} {HEIGHT}v-{MARKS}" for at in places)
    return (
        f'<svg width="{WIDTH}" height="{HEIGHT}" viewBox="0 0 {WIDTH} {HEIGHT}" role="img">'
        f'<polyline points="{points}" fill="none" stroke="#1f77b4"/><path d="{ticks}" stroke="#d62728"/></svg>'
        f" {low:.4g} .. {high:.4g}"
    )


def _marks(run: Any) -> Array:
    """Times of impacts, or of switches."""
    if isinstance(run, Trajectory):
        return np.asarray(blows(run.impacts).time)
    return np.asarray(run.switches.time)


def _events(run: Any) -> tuple[str, str]:
    """How many events of each kind."""
    switches = "" if isinstance(run, Trajectory) else f"{len(run.switches)}"
    if run.impacts is None:
        return "switches", switches
    counts = {kind.name.lower(): int(np.sum(run.impacts.kind == kind)) for kind in Kind}
    counts |= {"switches": len(run.switches)} if switches else {}
    return "events", ", ".join(f"{n} {name}" for name, n in counts.items() if n) or "none"
