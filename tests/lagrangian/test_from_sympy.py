"""Mechanisms from SymPy's mechanics move as those derived from a Lagrangian, whatever speeds they were written in."""

import numpy as np
import pytest

from lcpstep import EventDriven, simulate

pytest.importorskip("sympy")
from sympy import cos, sin, symbols
from sympy.physics.mechanics import (
    KanesMethod,
    LagrangesMethod,
    Particle,
    Point,
    ReferenceFrame,
    dynamicsymbols,
)

from lagrangian.symbolic import derive, from_sympy

a, b, ua, ub = dynamicsymbols("a b u_a u_b")
m, L, g, c = symbols("m L g c")
T = dynamicsymbols._t
VALUES = {"m": 0.7, "L": 0.5, "g": 9.81, "c": 0.3}
GAP = L * sin(a) + L * sin(b) + 0.2


def double_pendulum(kinematics):
    """Kane's equations of two points on rods, a damper at the first joint; speeds as the kinematic equations say."""
    N, fixed = ReferenceFrame("N"), Point("O")
    fixed.set_vel(N, 0)
    P, Q = (Point(x) for x in "PQ")
    P.set_pos(fixed, L * (sin(a) * N.x - cos(a) * N.y))
    Q.set_pos(P, L * (sin(b) * N.x - cos(b) * N.y))
    rates = KanesMethod(N, [a, b], [ua, ub], kd_eqs=kinematics).kindiffdict()
    for point in (P, Q):
        point.set_vel(N, point.pos_from(fixed).dt(N).subs(rates))
    bodies = [Particle(f"body {point.name}", point, m) for point in (P, Q)]
    loads = [(point, -m * g * N.y) for point in (P, Q)]
    frame = N.orientnew("A", "Axis", [a, N.z])
    frame.set_ang_vel(N, rates[a.diff(T)] * N.z)
    kane = KanesMethod(N, [a, b], [ua, ub], kd_eqs=kinematics)
    kane.kanes_equations(bodies, [*loads, (frame, -c * rates[a.diff(T)] * N.z)])
    return kane


def by_lagrange():
    x, y = L * sin(a), -L * cos(a)
    X, Y = x + L * sin(b), y - L * cos(b)
    kinetic = m * sum(z.diff(T) ** 2 for z in (x, y, X, Y)) / 2
    return derive(kinetic - m * g * (y + Y), [a, b], parameters=VALUES, dissipation=c * a.diff(T) ** 2 / 2, gaps=GAP,
                  restitution=0.6)  # fmt: skip


def motion(mechanism):
    scene = mechanism.scene([0.5, 0.3], [0.1, -0.4], (0.0, 1.5))
    return simulate(scene, EventDriven(1e-11, 1e-11), keep=np.linspace(0.0, 1.5, 9))


@pytest.fixture(scope="module")
def known():
    return motion(by_lagrange())


@pytest.mark.parametrize(
    "kinematics",
    [
        pytest.param([ua - a.diff(T), ub - b.diff(T)], marks=pytest.mark.slow),
        # absolute rate of the second rod
        pytest.param([ua - a.diff(T), ub - a.diff(T) - b.diff(T)], marks=pytest.mark.slow),
        # depends on place and time
        pytest.param(
            [ua - 2 * a.diff(T) - 0.1 * sin(T), ub - (2 + cos(a)) * b.diff(T) - 0.3 * b],
            marks=pytest.mark.slow,
        ),
    ],
    ids=["rates", "sums", "any"],
)
def test_kanes_equations_in_any_speeds_give_the_same_motion(known, kinematics):
    mechanism = from_sympy(double_pendulum(kinematics), parameters=VALUES, gaps=GAP, restitution=0.6)
    found = motion(mechanism)
    assert len(found.impacts) == len(known.impacts) > 0
    assert found.q == pytest.approx(known.q, abs=1e-8)
    assert found.v == pytest.approx(known.v, abs=1e-7)
    with pytest.raises(ValueError, match="energy: not known"):
        mechanism.energy(0.0, [[0.0, 0.0]], [[0.0, 0.0]])


@pytest.mark.slow
def test_lagranges_method_and_systems_enter_too(known):
    x, y = L * sin(a), -L * cos(a)
    kinetic = m * sum(z.diff(T) ** 2 for z in (x, y, x + L * sin(b), y - L * cos(b))) / 2
    lagrange = LagrangesMethod(kinetic - m * g * (2 * y - L * cos(b)), [a, b])
    lagrange.form_lagranges_equations()
    undamped = motion(from_sympy(lagrange, parameters=VALUES, gaps=GAP, restitution=0.6))
    same = motion(by_lagrange_without_damper())
    assert undamped.q == pytest.approx(same.q, abs=1e-8)


def by_lagrange_without_damper():
    x, y = L * sin(a), -L * cos(a)
    X, Y = x + L * sin(b), y - L * cos(b)
    kinetic = m * sum(z.diff(T) ** 2 for z in (x, y, X, Y)) / 2
    return derive(kinetic - m * g * (y + Y), [a, b], parameters=VALUES, gaps=GAP, restitution=0.6)


def test_a_system_of_joints_and_bodies():
    """A pendulum put together from sympy's bodies and pin joint: theta'' = -m g l sin(theta)/(I + m l^2)."""
    mechanics = pytest.importorskip("sympy.physics.mechanics", reason="no System")
    if not hasattr(mechanics, "System"):
        pytest.skip("sympy has no System")
    wall, rod = mechanics.RigidBody("wall"), mechanics.RigidBody("rod")
    theta, omega = dynamicsymbols("theta omega")
    pin = mechanics.PinJoint(
        "pin", wall, rod, theta, omega, child_point=-L * rod.frame.x, joint_axis=wall.frame.z
    )
    system = mechanics.System.from_newtonian(wall)
    system.add_joints(pin)
    system.apply_uniform_gravity(g * wall.frame.x)
    system.form_eoms()
    inertia = rod.central_inertia.dot(rod.frame.z).dot(rod.frame.z)
    values = {**VALUES, str(inertia): 0.02, str(rod.mass): 0.7}
    values = {k: x for k, x in values.items() if k not in ("m", "c")}
    found = from_sympy(system, parameters=values, gaps=theta + 0.2)
    acceleration = np.zeros(1)
    found.system.force(
        0.0, np.array([0.6]), np.array([0.3]), np.array(list(found.parameters.values())), acceleration
    )
    M = np.zeros((1, 1))
    p = np.array(list(found.parameters.values()))
    M = np.asarray(found.system.mass) if not callable(found.system.mass) else filled(found.system.mass, p)
    expected = -0.7 * 9.81 * 0.5 * np.sin(0.6) / (0.02 + 0.7 * 0.25)
    assert acceleration[0] / M[0, 0] == pytest.approx(expected, rel=1e-12)


def filled(mass, p):
    out = np.zeros((1, 1))
    mass(0.0, np.array([0.6]), np.array([0.3]), p, out)
    return out


def test_what_cannot_enter_says_why():
    with pytest.raises(
        ValueError, match="method: expected a SymPy System, KanesMethod or LagrangesMethod, got 3"
    ):
        from_sympy(3)
    N = ReferenceFrame("N")
    with pytest.raises(ValueError, match=r"not formed yet; call kanes_equations\(\) first"):
        from_sympy(KanesMethod(N, [a], [ua], kd_eqs=[ua - a.diff(T)]))
    kane = double_pendulum([ua - a.diff(T), ub - b.diff(T)])
    with pytest.raises(ValueError, match="unknown c"):
        from_sympy(kane, parameters={k: x for k, x in VALUES.items() if k != "c"})
    tied = KanesMethod(
        N, [a], [ua], kd_eqs=[ua - a.diff(T), ub - b.diff(T)], q_dependent=[b], u_dependent=[ub],
        configuration_constraints=[a - b], velocity_constraints=[ua - ub],
    )  # fmt: skip
    fixed, P = Point("O"), Point("P")
    fixed.set_vel(N, 0)
    P.set_pos(fixed, a * N.x + b * N.y)
    P.set_vel(N, ua * N.x + ub * N.y)
    tied.kanes_equations([Particle("body", P, m)], [(P, -m * g * N.y)])
    with pytest.raises(
        ValueError, match=r"method: expected independent coordinates and speeds, got b\(t\), u_b\(t\)"
    ):
        from_sympy(tied, parameters=VALUES)
