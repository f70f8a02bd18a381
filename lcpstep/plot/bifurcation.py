"""Pictures of brute-force bifurcation diagrams: panels over the parameter, one above the other.

The panels are those of G. Osorio, Complex Behavior in Impacting Systems, Figs 4.5 to 4.12: phases of the impacts,
position on the stroboscopic section, and for motions that chatter the accumulation points and how many impacts
there are.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from lagrangian import checks
from lagrangian.labels import own_unit
from lcpstep.plot.words import on_section, parameter_label

PANELS = {
    "phase": "phase of impacts [periods]",
    "speed": "gap velocity\nbefore impacts",
    "position": "position\non the section",
    "velocity": "velocity\non the section",
    "accumulation": "accumulation points:\nphase [periods]",
    "impacts": "impacts per period",
}
MODES = {  # the same of a scene with modes
    "phase": "phase of switches [periods]",
    "speed": "rate of the guard\nbefore switches",
    "accumulation": "sliding begins:\nphase [periods]",
    "impacts": "switches per period",
}
LISTED = {"phase": "impact_phase", "speed": "impact_before", "accumulation": "landing_phase"}
PLACES = {"position": 0, "velocity": 1}  # of the first and the middle state
USUAL = ("phase", "position")
CHATTERING = ("accumulation", "impacts")
PHASES = ("phase", "accumulation")
LETTERS = "abcdefghijklmnopqrstuvwxyz"
MISSING = "C3"
ABOVE: dict[str, Any] = {
    "loc": "lower right",
    "bbox_to_anchor": (1.0, 1.02),
    "fontsize": 8,
    "frameon": False,
    "ncols": 4,
}
NARROW = 0.25  # of the period
FINE = 4000  # places along an axis that can be told apart


def bifurcation(data: Any, title: str = "", show: Sequence[str] | None = None) -> Any:
    """Figure of a bifurcation dataset.

    Parameters
    ----------
    show : names of `PANELS`; where not given, phases and positions, and where sequences of impacts end within the
        window their accumulation points and the number of impacts
    """
    checks.has("data", data, "attrs", "a dataset of lcpstep.analysis.bifurcation")
    shown = list(show or panels_of(data))
    figure, axes = _figure(len(shown), title or f"{data.attrs['scene']}: {data.attrs['start']} start")
    for ax, name in zip(axes, shown, strict=True):
        panel(ax, data, name)
    _over(axes, data)
    return figure


def panels_of(data: Any) -> tuple[str, ...]:
    """The panels that say something of a diagram."""
    return USUAL + (CHATTERING if data.sizes["landing"] else ())


def overlaid(
    reference: Any, others: Mapping[str, Any], apart: Mapping[str, Any], title: str = "",
    show: Sequence[str] | None = None,
) -> Any:  # fmt: skip
    """Figure of one bifurcation diagram in black and others, by name, under it; below, how far each is from it.

    apart : of each other one, by the same names, from `lcpstep.analysis.agreement.agreement`
    """
    parameter = str(reference.attrs["parameter"])
    shown = list(show or USUAL)
    figure, axes = _figure(
        len(shown) + 1, title or f"{reference.attrs['scene']}: {reference.attrs['start']} start"
    )
    distance = axes[-1]
    for ax, name in zip(axes, shown, strict=False):
        for k, other in enumerate(others.values()):
            panel(ax, other, name, f"C{k}", 2.5)
        panel(ax, reference, name, "k")
    for k, name in enumerate(others):
        away = apart[name]["phase_distance"].values
        distance.semilogy(reference[parameter].values, away, f"C{k}.-", label=name)
    distance.semilogy([], [], "k.", label="reference")
    distance.set(ylabel="distance of\nthe phases [periods]")
    distance.grid(alpha=0.3)
    distance.legend(loc="center left", bbox_to_anchor=(1.0, 0.5), fontsize=8)
    _over(axes, reference)
    return figure


def panel(ax: Any, data: Any, name: str, colour: str | None = None, larger: float = 1.0) -> None:
    """Points of one panel; where no colour is given, those of several contacts in colours of their own."""
    checks.has("ax", ax, "plot", "axes of matplotlib")
    checks.has("data", data, "attrs", "a dataset of lcpstep.analysis.bifurcation")
    x, y = points(data, name)
    size = larger * float(np.clip(2400.0 / len(data[str(data.attrs["parameter"])]), 2.5, 4.0))
    contact = contacts(data, name, len(y)) if colour is None else np.zeros(len(y))
    several = sorted(set(contact) | {0})
    for c in several:
        shown, here = colour or ("k" if c == 0 else f"C{c}"), contact == c
        told = f"contact {c}" if len(several) > 1 else None
        ax.plot(*thinned(x[here], y[here]), ".", color=shown, ms=size, mew=0.0, rasterized=True, label=told)
    if len(several) > 1:
        ax.legend(**ABOVE, markerscale=3.0)
    ax.set_ylabel(label(data, name))
    if name in PHASES:
        ax.set_ylim(phases_shown(y) if name == "accumulation" else (0.0, 1.0))
        corners(ax, data)
    if name == "impacts":
        ax.set_ylim(bottom=0.0)
    if name in ("phase", "speed", "impacts"):
        _warned(ax, data)


def label(data: Any, name: str) -> str:
    """What a panel shows, with its unit; states by their own names, and switches where a scene has modes."""
    labels = data.attrs["labels"]
    if name in PLACES:
        return on_section(labels[PLACES[name] * (len(labels) // 2)]).replace(
            " on the section", "\non the section"
        )
    if data.attrs["modes"]:
        return MODES.get(name, PANELS[name])
    return PANELS[name] + (f" [{own_unit('m/s', labels)}]" if name == "speed" else "")


def phases_shown(phases: np.ndarray) -> tuple[float, float]:
    """Limits of an axis of phases: the whole period, or where all are in a small part of it, that part."""
    low, high = (float(np.min(phases)), float(np.max(phases))) if len(phases) else (0.0, 1.0)
    if high - low > NARROW:
        return 0.0, 1.0
    return max(0.0, low - 0.5 * (high - low) - 0.01), min(1.0, high + 0.5 * (high - low) + 0.01)


def points(data: Any, name: str) -> tuple[np.ndarray, np.ndarray]:
    """Parameter and ordinate of every point of a panel."""
    values = data[str(data.attrs["parameter"])].values
    if name in LISTED:
        kind = LISTED[name].split("_")[0]
        return values[data[f"{kind}_value"].values], data[LISTED[name]].values
    if name == "impacts":
        y = np.where(data["status"].values[..., None] == 0, data["impacts"].values, np.nan)
    elif data.attrs["modes"]:
        y = data["x"].isel(state=PLACES[name] * (data.sizes["state"] // 2)).values
    else:
        y = data[{"position": "q", "velocity": "v"}[name]].isel(coordinate=0).values
    return np.broadcast_to(values[None, :, None], y.shape).ravel(), y.ravel()


def contacts(data: Any, name: str, n: int) -> np.ndarray:
    """The contact of each of the n points of a panel; 0 where it is of none, and in files that do not tell."""
    kind = LISTED.get(name, "").split("_")[0]
    told = f"{kind}_contact" in data
    return data[f"{kind}_contact"].values if told else np.zeros(n, dtype=int)


def thinned(x: np.ndarray, y: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """One of all points that would lie on each other in the picture: a periodic motion repeats itself."""
    seen = np.isfinite(y)
    x, y = x[seen], y[seen]
    if len(y) == 0:
        return x, y
    cell = np.round((y - np.min(y)) / max(float(np.ptp(y)), 1e-300) * FINE).astype(np.int64)
    column = np.unique(x, return_inverse=True)[1]
    kept = np.unique(column * (FINE + 1) + cell, return_index=True)[1]
    return x[kept], y[kept]


def corners(ax: Any, data: Any) -> None:
    """Lines at the corners of the forcing, with a letter each at the right end."""
    values = data[str(data.attrs["parameter"])].values
    for k, phase in enumerate(data["corner_phase"].values.T):
        ax.plot(values, phase, color="C0", lw=0.6, alpha=0.7, zorder=0.5)
        if len(LETTERS) > k and ax.get_ylim()[0] <= phase[-1] <= ax.get_ylim()[1]:
            ax.annotate(
                LETTERS[k], (1.0, phase[-1]), (4.0 + 9.0 * (k % 2), 0.0), xycoords=("axes fraction", "data"),
                textcoords="offset points", color="C0", fontsize=8, va="center",
            )  # fmt: skip


def _warned(ax: Any, data: Any) -> None:
    """Marks along the top where impacts of a period are missing, and where runs ended early."""
    values = data[str(data.attrs["parameter"])].values
    most = int(data.attrs["most"])
    event = "switches" if data.attrs["modes"] else "impacts"
    cut = np.any(data["impacts"].values > most, axis=(0, 2))
    early = np.any(data["status"].values != 0, axis=0)
    for which, mark, text in (
        (
            cut,
            "v",
            f"more than {most} {event} a period: only the first {most} are shown",
        ),
        (early, "x", "a run ended early"),
    ):
        if np.any(which):
            ax.plot(
                values[which], np.full(np.sum(which), 1.0), mark, color=MISSING, ms=5, clip_on=False, label=text,
                transform=ax.get_xaxis_transform(),
            )  # fmt: skip
            ax.legend(**ABOVE)


def _figure(rows: int, title: str) -> tuple[Any, Any]:
    from lcpstep.plot.figures import Figure

    figure = Figure(figsize=(11, 1.0 + 3.2 * rows), layout="constrained")
    figure.suptitle(title)
    return figure, figure.subplots(rows, 1, sharex=True, squeeze=False)[:, 0]


def _over(axes: Any, data: Any) -> None:
    """The common axis, which ends where the window does."""
    parameter = str(data.attrs["parameter"])
    values = data[parameter].values
    axes[-1].set_xlabel(parameter_label(parameter))
    if len(values) > 1:
        axes[-1].set_xlim(values[0], values[-1])
