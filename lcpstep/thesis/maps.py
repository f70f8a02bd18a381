"""Chapters 2 and 6: diagrams of maps whose formulas are known, smooth ones and piecewise-linear ones."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
from numpy.typing import NDArray

from lcpstep.analysis.border_collision import PiecewiseLinearMap, classify, diagram
from lcpstep.analysis.continuation import Branch, Steps, continue_point

Array = NDArray[np.float64]
NORMAL_FORMS: dict[str, tuple[Callable[[float], Callable[[Array], Array]], list[tuple[float, float]]]] = {
    # x -> image; points (x, a) through which branches are followed
    "fold: x → x + a − x²": (lambda a: lambda x: x + a - x * x, [(0.7, 0.49)]),
    "transcritical: x → x + a x − x²": (lambda a: lambda x: x + a * x - x * x, [(0.0, -0.4), (-0.4, -0.4)]),
    "pitchfork: x → x + a x − x³": (lambda a: lambda x: x + a * x - x**3, [(0.0, -0.4), (0.6, 0.36)]),
    "flip: x → −(1 + a) x + x³": (lambda a: lambda x: -(1.0 + a) * x + x**3, [(0.0, -0.4)]),
}
SCENARIOS = {  # trace and determinant before and after the border
    "fixed point to fixed point": (0.3, 0.2, -0.6, 0.3),
    "nothing to fixed point": (1.6, 0.5, 0.2, 0.3),
    "fixed point to period two": (0.4, 0.1, -1.6, 0.1),
    "fixed point to period three": (0.6, 0.1, -2.6, 0.1),
    "fixed point to chaos": (0.4, 0.3, -1.6, 0.3),
    "nothing to chaos": (1.5, 0.1, -1.4, 0.1),
}


def normal_forms() -> tuple[Any, dict[str, Any]]:
    """Chapter 2: fixed points over the parameter, stable solid, unstable dashed; of the flip its period two too."""
    from matplotlib.figure import Figure

    from lcpstep.plot.orbits import STABLE, UNSTABLE

    figure = Figure(figsize=(11, 7), layout="constrained")
    figure.suptitle("normal forms of bifurcations of maps: stable solid, unstable dashed")
    data: dict[str, Any] = {}
    for ax, (name, (family, starts)) in zip(figure.subplots(2, 2).ravel(), NORMAL_FORMS.items(), strict=True):
        branches = [b for x, a in starts for b in _both_ways(family, x, a, 1)]
        if name.startswith("flip"):
            branches += [b for x in (0.5, -0.5) for b in _both_ways(family, x, 0.25, 2)]
        data[name] = [{"a": b.p, "x": b.x[:, 0], "stable": b.stable} for b in branches]
        for b in branches:
            for a, x, stable in to_the_bifurcation(b):
                ax.plot(a, x, **(STABLE if stable else UNSTABLE))
        ax.set(title=name, xlabel="a", ylabel="x")
        ax.grid(alpha=0.3)
    return figure, data


def to_the_bifurcation(branch: Branch) -> list[tuple[Array, Array, bool]]:
    """Parts of a branch that are stable or unstable throughout, each up to the bifurcation at x = a = 0."""
    a, x, stable = branch.p, branch.x[:, 0], np.asarray(branch.stable, dtype=bool)
    changes = np.flatnonzero(stable[1:] != stable[:-1]) + 1
    parts = []
    for first, end in zip([0, *changes], [*changes, len(a)], strict=True):
        before, after = [0.0] if first else [], [0.0] if end < len(a) else []
        own = slice(int(first), int(end))
        parts.append(
            (np.array([*before, *a[own], *after]), np.array([*before, *x[own], *after]), bool(stable[first]))
        )
    return parts


def _both_ways(family: Any, x: float, a: float, n: int) -> list[Branch]:
    steps = Steps(largest=0.02)
    return [
        continue_point(family, [x], a, (-0.5, 0.5), n=n, steps=steps, forward=forward)
        for forward in (True, False)
    ]


def normal_form(
    trace_minus: float, det_minus: float, trace_plus: float, det_plus: float
) -> PiecewiseLinearMap:
    """The piecewise-linear normal form in two dimensions: companion matrices that share their second column."""
    A = [
        np.array([[tau, 1.0], [-delta, 0.0]])
        for tau, delta in ((trace_minus, det_minus), (trace_plus, det_plus))
    ]
    return PiecewiseLinearMap(A[0], A[1], [1.0, 0.0], [1.0, 0.0], [1.0, 0.0], 0.0)


def scenarios() -> tuple[Any, dict[str, Any]]:
    """Chapter 6: what border collisions lead to, by the traces and determinants of both sides."""
    from matplotlib.figure import Figure

    figure = Figure(figsize=(13, 7.5), layout="constrained")
    figure.suptitle("border collisions of x → A± x + (1, 0) m, the border at x₁ = 0: diagrams of the map")
    m = np.linspace(-1.0, 1.0, 161)
    data: dict[str, Any] = {"m": m}
    for ax, (name, values) in zip(figure.subplots(2, 3).ravel(), SCENARIOS.items(), strict=True):
        f = normal_form(*values)
        points, found = diagram(f, m, drop=600, keep=80), classify(f)
        data[name] = {"points": [p[:, 0] for p in points], "verdict": found.words}
        x = np.concatenate([np.full(len(y), a) for a, y in zip(m, points, strict=True)])
        ax.plot(x, np.concatenate([y[:, 0] for y in points]), "k.", ms=1.5, mew=0.0, rasterized=True)
        ax.axvline(0.0, color="C0", lw=0.8)
        ax.axhline(0.0, color="C0", lw=0.8, ls=":")
        title = "tr, det of A−: {:g}, {:g}; of A+: {:g}, {:g}".format(*values)
        ax.set(
            title=f"{name}\n{found.words}\n{title}",
            xlabel="m",
            ylabel="x₁",
            xlim=(-1.0, 1.0),
            xticks=(-1.0, -0.5, 0.0, 0.5, 1.0),
        )
        ax.title.set_fontsize(9)
        ax.grid(alpha=0.3)
    return figure, data
