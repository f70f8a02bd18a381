"""A mechanism from its Lagrangian: a double pendulum whose lower bob bounces off a wall without loss.

Both its angles and the wall need no derivative by hand. Needs sympy: pip install "lcpstep[symbolic]".
"""

from sympy import Symbol, cos, sin, symbols
from sympy.physics.mechanics import dynamicsymbols

from lagrangian.symbolic import Mechanism, derive
from lcpstep import EventDriven, simulate


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


def energy_drift(rtol: float = 1e-11) -> float:
    """Largest change of the energy within five seconds and several impacts [J]; it is zero in theory."""
    mechanism = double_pendulum()
    scene = mechanism.scene(q0=[1.0, 0.5], v0=[0.0, 0.0], t_span=(0.0, 5.0))
    motion = simulate(scene, EventDriven(rtol=rtol, atol=rtol))
    energy = mechanism.energy(motion.t, motion.q, motion.v)
    return float(abs(energy - energy[0]).max())


if __name__ == "__main__":
    equations = double_pendulum().equations
    print("M =", equations.M, "\nN =", equations.N, "\nF =", equations.F)
    print(f"the energy drifts by {energy_drift():.1e} J in five seconds")
