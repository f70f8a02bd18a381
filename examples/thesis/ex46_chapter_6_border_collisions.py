"""Chapter 6: what a border collision leads to
===========================================

A map that is linear on both sides of a border, and continuous on it. As a parameter m moves its fixed point
through the border, anything may follow: another fixed point, period two or three, chaos, or nothing at all.
Traces and determinants of both sides decide, by Feigin's rules, and the diagrams obey.

Source: M. di Bernardo, M. I. Feigin, S. J. Hogan, M. E. Homer (1999); G. Osorio's thesis, chapter 6.
"""

import numpy as np
from matplotlib.figure import Figure

from lcpstep.analysis.border_collision import PiecewiseLinearMap, classify, diagram

CASES = {  # trace and determinant before and after the border
    "fixed point to fixed point": (0.3, 0.2, -0.6, 0.3),
    "to period two": (0.4, 0.1, -1.6, 0.1),
    "to period three": (0.6, 0.1, -2.6, 0.1),
    "nothing to chaos": (1.5, 0.1, -1.4, 0.1),
}


def normal_form(trace1: float, det1: float, trace2: float, det2: float) -> PiecewiseLinearMap:
    """The map x -> A x + (1, 0) m, the border at x1 = 0."""
    A = [np.array([[trace, 1.0], [-det, 0.0]]) for trace, det in ((trace1, det1), (trace2, det2))]
    return PiecewiseLinearMap(A[0], A[1], [1.0, 0.0], [1.0, 0.0], [1.0, 0.0], 0.0)


def settled(name: str, m: float) -> int:
    """How many points the orbit of a case visits at m, in the end; 0 where it leaves all bounds."""
    points = diagram(normal_form(*CASES[name]), [m], drop=600, keep=60)[0]
    return len(np.unique(points[:, 0].round(9)))


def picture() -> Figure:
    """The four diagrams."""
    figure = Figure(figsize=(8.5, 6.4), layout="constrained")
    m = np.linspace(-1.0, 1.0, 121)
    for ax, (name, values) in zip(figure.subplots(2, 2).ravel(), CASES.items(), strict=True):
        f = normal_form(*values)
        points = diagram(f, m, drop=500, keep=60)
        x = np.concatenate([np.full(len(y), a) for a, y in zip(m, points, strict=True)])
        ax.plot(x, np.concatenate([y[:, 0] for y in points]), "k.", ms=1.6, mew=0.0, rasterized=True)
        ax.axvline(0.0, color="C3", lw=1.0, ls="--")
        ax.set(title=f"{name}\n{classify(f).words}", xlabel="m", ylabel="x1", xlim=(-1.0, 1.0))
        ax.title.set_fontsize(9)
        ax.grid(alpha=0.3)
    return figure


if __name__ == "__main__":
    print("points visited at m = 0.5:", {name: settled(name, 0.5) for name in CASES})
    picture().savefig("chapter-6-border-collisions.png", dpi=110)
