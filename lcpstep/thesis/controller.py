"""Chapter 7: friction on four roads, phase portraits of the anti-lock controller, its cycle over the threshold."""

from __future__ import annotations

from typing import Any

import numpy as np

from lagrangian.scenes.hybrid_abs import ROADS, holding_torque, hybrid_abs
from lcpstep.analysis.abs_basins import basins
from lcpstep.analysis.abs_cycle import limit_cycle, peak
from lcpstep.analysis.abs_parameters import bifurcation, vanishing
from lcpstep.plot.abs_cycle import overview
from lcpstep.plot.orbits import STABLE, UNSTABLE

# Of the two other roads: M. Burckhardt, Fahrwerktechnik: Radschlupf-Regelsysteme (Vogel 1993); U. Kiencke,
# L. Nielsen, Automotive Control Systems (Springer 2000), table of c1, c2, c3
OTHERS = {"dry cobblestone": (1.3713, 6.4565, 0.6691), "snow": (0.1946, 94.129, 0.0646)}
TORQUES = (0.0, 2500.0)
CELLS, DENSITY = 60, 0.6


def roads() -> tuple[Any, dict[str, Any]]:
    """Fig 7.2."""
    from matplotlib.figure import Figure

    slip = np.linspace(0.0, 1.0, 1001)
    figure = Figure(figsize=(8, 5), layout="constrained")
    ax = figure.subplots()
    data: dict[str, Any] = {"slip": slip}
    named: dict[str, Any] = {f"{name} asphalt": th for name, th in ROADS.items()} | OTHERS
    for k, (name, (a, b, c)) in enumerate(named.items()):
        mu = a * (1.0 - np.exp(-slip * b)) - slip * c
        data[name] = mu
        ax.plot(slip, mu, f"C{k}", lw=1.5)
        ax.annotate(
            f"{name}\nθ = {a:g}, {b:g}, {c:g}",
            (1.0, mu[-1]),
            (4.0, 0.0),
            textcoords="offset points",
            va="center",
            color=f"C{k}",
            fontsize=9,
        )
    ax.set(xlabel="slip λ [-]", ylabel="friction coefficient μ [-]", xlim=(0.0, 1.0), ylim=(0.0, None))
    ax.set_title("μ(λ) = θ₁ (1 − exp(−λ θ₂)) − λ θ₃")
    ax.grid(alpha=0.3)
    return figure, data


def ramps() -> tuple[Any, dict[str, Any]]:
    """Fig 7.4."""
    return _portraits(("0", "2"))


def holds() -> tuple[Any, dict[str, Any]]:
    """Fig 7.5."""
    return _portraits(("1", "3"))


def _portraits(states: tuple[str, ...]) -> tuple[Any, dict[str, Any]]:
    """Vector field, isocline and thresholds in the plane of slip and torque."""
    from matplotlib.figure import Figure

    scene = hybrid_abs("dry")
    p = scene.parameters
    what = {
        "0": "torque rises",
        "1": "torque held at T_max",
        "2": "torque falls",
        "3": "torque held at T_min",
    }
    rate = {"0": float(p["rate"]), "1": 0.0, "2": -float(p["rate"]), "3": 0.0}
    slip, torque = np.linspace(0.0, 1.0, 41), np.linspace(*TORQUES, 41)
    psi = np.array([holding_torque(float(s), scene.p) for s in slip])
    factor = float(p["radius"]) / (float(p["inertia"]) * float(p["speed"]))
    speed = -factor * (psi[None, :] - torque[:, None])
    figure = Figure(figsize=(12, 5), layout="constrained")
    figure.suptitle(f"anti-lock controller, dry road, {float(p['speed']):g} m/s: motion in single states")
    fine = np.linspace(0.0, 1.0, 400)
    for ax, state in zip(figure.subplots(1, len(states), sharey=True), states, strict=True):
        # Arrows of equal length on the page: components in units of the axes
        u, v = speed, np.full_like(speed, rate[state] / (TORQUES[1] - TORQUES[0]))
        ax.streamplot(slip, torque / TORQUES[1], u, v, color="0.6", density=DENSITY, linewidth=0.7, arrowsize=0.8,
                      broken_streamlines=False)  # fmt: skip
        ax.plot(
            fine,
            [holding_torque(float(s), scene.p) / TORQUES[1] for s in fine],
            "k--",
            lw=1.0,
            label="isocline T = Ψ(λ)",
        )
        for name in ("slip_min", "slip_max"):
            ax.axvline(float(p[name]), color="C0", lw=0.8)
        for name in ("torque_min", "torque_max"):
            ax.axhline(float(p[name]) / TORQUES[1], color="C3", lw=0.8)
        ax.set_yticks(np.arange(0.0, 1.01, 0.2), [f"{x * TORQUES[1]:g}" for x in np.arange(0.0, 1.01, 0.2)])
        ax.set(title=f"state {state}: {what[state]}", xlabel="slip λ [-]", xlim=(0.0, 1.0), ylim=(0.0, 1.0))
    figure.axes[0].set_ylabel("brake torque T [N m]")
    figure.axes[-1].plot([], [], "C0-", lw=0.8, label="slip thresholds")
    figure.axes[-1].plot([], [], "C3-", lw=0.8, label="torque thresholds")
    figure.axes[-1].legend(fontsize=8, loc="upper left", bbox_to_anchor=(1.0, 1.0))
    return figure, {"slip": slip, "torque": torque, "slip_rate": speed, "torque_rate": rate}


def overview_of_all() -> tuple[Any, dict[str, Any]]:
    """Cycle, series, bifurcation and basins."""
    scene = hybrid_abs("dry")
    cycle = limit_cycle(scene)
    low = vanishing(scene)
    over = bifurcation(scene, low + (1626.9 - low) * np.linspace(0.02, 1.0, 60) ** 2)
    slip, torque = ((np.arange(CELLS) + 0.5) / CELLS * (b - a) + a for a, b in ((0.0, 1.0), TORQUES))
    found = basins(scene, slip, torque)
    figure = overview(scene, cycle, over, found, "hybrid anti-lock controller, dry road, model 'slip'")
    return figure, {"cycle": cycle.as_dict(), "bifurcation": over.as_dict(), "basins": found.shares()}


def over_threshold() -> tuple[Any, dict[str, Any]]:
    """Fig 7.15: the slip of the cycle, and of the equilibria T = Psi(slip) that are left where it has vanished."""
    from matplotlib.figure import Figure

    scene = hybrid_abs("dry")
    slip_at_top, top = peak(scene)
    low = vanishing(scene)
    values = low + (1626.9 - low) * np.linspace(0.005, 1.0, 80) ** 2
    over = bifurcation(scene, values)
    slip = np.linspace(0.0, 1.0, 2001)
    psi = np.array([holding_torque(float(s), scene.p) for s in slip])
    figure = Figure(figsize=(10, 5.5), layout="constrained")
    ax = figure.subplots()
    for which, style, label in (
        (slip <= slip_at_top, STABLE, "equilibrium, stable"),
        (slip >= slip_at_top, UNSTABLE, "equilibrium, unstable"),
    ):  # fmt: skip
        ax.plot(psi[which], slip[which], label=label, **style)
    ax.fill_between(over.torque_max, over.slip_low, over.slip_high, color="C0", alpha=0.15, lw=0.0)
    ax.plot(over.torque_max, over.slip_low, "C0-", label="cycle: smallest and largest slip")
    ax.plot(over.torque_max, over.slip_high, "C0-")
    ax.axvline(top, color="0.5", lw=0.8)
    ax.annotate(f"max Ψ = {top:.6f} N m", (top, 1.0), (3.0, -3.0), xycoords=("data", "axes fraction"),
                textcoords="offset points", va="top", fontsize=8)  # fmt: skip
    ax.set(xlabel="torque threshold T_max [N m]", ylabel="slip λ [-]", xlim=(900.0, 1700.0), ylim=(0.0, 0.7))
    ax.set_title("cycle and equilibria of the anti-lock controller, dry road")
    ax.legend(fontsize=8, loc="upper left", bbox_to_anchor=(1.0, 1.0))
    ax.grid(alpha=0.3)
    return figure, {"bifurcation": over.as_dict(), "slip": slip, "holding_torque": psi}
