"""Complementarity without mechanics: a string over an obstacle
============================================================

A string is stretched over a hill. Either it touches, or no force holds it up: gap and force are complementary
at every place, z >= 0, w = W z + b >= 0, z w = 0. `solve_lcp` takes such problems from anywhere; here two
thousand unknowns with a sparse matrix. Where the string leaves the hill is known: at 1 - sqrt(1 -
height/curvature).

Source: J. F. Rodrigues, Obstacle Problems in Mathematical Physics (1987).
"""

import math

import numpy as np
from matplotlib.figure import Figure
from scipy.sparse import diags_array

from lcpstep import solve_lcp

HEIGHT, CURVATURE = 0.5, 2.0


def string(n: int = 1999) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
    """Places, hill, string and force on it, at n places between its ends."""
    x = np.linspace(-1.0, 1.0, n + 2)[1:-1]
    hill = HEIGHT - CURVATURE * x**2
    W = diags_array([-1.0, 2.0, -1.0], offsets=[-1, 0, 1], shape=(n, n)).tocsr() * (n + 1) / 2
    solution = solve_lcp(W, W @ hill, method="auto")
    return x, hill, hill + solution.z, solution.w * (n + 1) / 2


def edge_error() -> float:
    """How far the last place that touches is from theory [m]; places are 1e-3 apart."""
    x, hill, u, _ = string()
    return abs(x[u == hill].max() - (1.0 - math.sqrt(1.0 - HEIGHT / CURVATURE)))


def picture() -> Figure:
    """The string, and the force that holds it."""
    x, hill, u, force = string()
    figure = Figure(figsize=(7.5, 5.0), layout="constrained")
    above, below = figure.subplots(2, 1, sharex=True, height_ratios=[2.0, 1.0])
    above.fill_between(x, np.maximum(hill, -0.15), -0.15, color="0.8", label="hill")
    above.plot(x, u, "C0-", lw=1.8, label="string")
    above.set(ylabel="height [m]", ylim=(-0.15, 0.6))
    above.legend(loc="upper right")
    below.plot(x, force, "C3-", lw=1.4)
    below.set(xlabel="place x [m]", ylabel="force [N/m]", xlim=(-1.0, 1.0))
    for ax in (above, below):
        ax.grid(alpha=0.3)
    return figure


if __name__ == "__main__":
    print(f"the string leaves the hill {edge_error():.1e} m from where theory says")
    picture().savefig("string-over-an-obstacle.png")
