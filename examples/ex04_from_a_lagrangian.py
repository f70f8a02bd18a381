"""A mechanism from its Lagrangian
===============================

A double pendulum whose lower bob bounces off a wall without loss. Kinetic and potential energy and the distance
from the wall are written down; equations of motion, gap, Jacobian and their code are derived by SymPy.

Source: J. L. Lagrange, Mecanique analytique (1788). Needs sympy: `pip install "lcpstep[symbolic]"`.
"""

import numpy as np
from matplotlib.figure import Figure
from sympy import Symbol, cos, sin, symbols
from sympy.physics.mechanics import dynamicsymbols

from lagrangian.symbolic import Mechanism, derive
from lcpstep import EventDriven, Trajectory, simulate


def double_pendulum(restitution: float = 1.0) -> Mechanism:
    """Masses [kg] and lengths [m] of the arms and gravity [m/s^2] are the parameters; the wall is at x = -0.3 m."""
    t = Symbol("t")
    theta1, theta2 = dynamicsymbols("theta1 theta2")
    m1, m2, l1, l2, g = symbols("m1 m2 l1 l2 g")
    x1, y1 = l1 * sin(theta1), -l1 * cos(theta1)
    x2, y2 = x1 + l2 * sin(theta2), y1 - l2 * cos(theta2)
    kinetic = m1 * (x1.diff(t) ** 2 + y1.diff(t) ** 2) / 2 + m2 * (x2.diff(t) ** 2 + y2.diff(t) ** 2) / 2
    potential = m1 * g * y1 + m2 * g * y2
    return derive(
        kinetic - potential,
        coordinates=[theta1, theta2],
        parameters={"m1": 1.0, "m2": 0.5, "l1": 1.0, "l2": 0.7, "g": 9.81},
        gaps=[x2 + 0.3],
        restitution=restitution,
        name="double pendulum at a wall",
    )


def motion(mechanism: Mechanism, rtol: float = 1e-11) -> Trajectory:
    """Five seconds from rest."""
    scene = mechanism.scene(q0=[1.0, 0.5], v0=[0.0, 0.0], t_span=(0.0, 5.0))
    return simulate(scene, EventDriven(rtol=rtol, atol=rtol))


def energy_drift(rtol: float = 1e-11) -> float:
    """Largest change of the energy within five seconds and several impacts [J]; it is zero in theory."""
    mechanism = double_pendulum()
    run = motion(mechanism, rtol)
    energy = mechanism.energy(run.t, run.q, run.v)
    return float(abs(energy - energy[0]).max())


def picture() -> Figure:
    """The path of the lower bob in front of the wall, with its impacts."""
    run = motion(double_pendulum())
    t = np.unique(np.concatenate([np.linspace(0.0, 5.0, 3001), run.impacts.time]))
    figure = Figure(figsize=(6.0, 5.0), layout="constrained")
    ax = figure.subplots()
    ax.plot(*lower_bob(run.at(t)[0]), lw=1.0, label="lower bob")
    ax.plot(*lower_bob(run.at(run.impacts.time)[0]), "o", mfc="none", ms=7, color="C3", label="impact")
    ax.axvline(-0.3, color="0.3", lw=3.0, label="wall")
    ax.plot(0.0, 0.0, "k^", ms=9, label="pivot")
    ax.set(xlabel="x [m]", ylabel="y [m]", aspect="equal")
    ax.legend(loc="upper left", bbox_to_anchor=(1.0, 1.0), frameon=False)
    ax.grid(alpha=0.3)
    return figure


def lower_bob(q):
    """Its place (x, y) [m] from the angles, (n, 2)."""
    x = np.sin(q[:, 0]) + 0.7 * np.sin(q[:, 1])
    return x, -np.cos(q[:, 0]) - 0.7 * np.cos(q[:, 1])


if __name__ == "__main__":
    equations = double_pendulum().equations
    print("M =", equations.M, "\nN =", equations.N, "\nF =", equations.F)
    print(f"the energy drifts by {energy_drift():.1e} J in five seconds")
    picture().savefig("from-a-lagrangian.png")
