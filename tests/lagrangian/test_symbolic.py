"""Mechanisms from a Lagrangian: their equations, callbacks and motions against those written by hand."""

import functools
import math
import warnings

import numba
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

from lcpstep import EventDriven, Moreau, simulate
from tests.differences import derivative, jacobian
from tests.known import driven
from tests.lagrangian.mechanisms import (
    ARMS,
    MECHANISMS,
    T,
    arms_by_hand,
    arms_force,
    arms_mass,
    bead_on_turning_wire,
    derive,
    double_pendulum,
    dynamicsymbols,
    pendulum,
    shaken_pendulum,
    sympy,
    tip_and_lagrangian,
)
from tests.marks import slow

STEP = 1e-2  # of eighth-order differences: truncation 1e-16, rounding 1e-14
EXACT = EventDriven(rtol=1e-12, atol=1e-12)


@pytest.fixture(autouse=True, scope="module")
def cache_folder(tmp_path_factory):
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("XDG_CACHE_HOME", str(tmp_path_factory.mktemp("cache")))
        yield


def states(n_q):
    """(t, q, v) anywhere."""
    vector = arrays(float, n_q, elements=st.floats(-3.0, 3.0))
    return st.tuples(st.floats(0.0, 5.0), vector, vector)


def value(f, at, p, shape):
    """What a callback fills in."""
    out = np.full(shape, np.nan)
    f(*at, np.array(p), out)
    return out


def values(mechanism):
    return list(mechanism.parameters.values())


# --- equations


@settings(deadline=None)
@given(states(2))
def test_double_pendulum_has_the_masses_and_forces_written_by_hand(at):
    system, p = double_pendulum().system, list(ARMS.values())
    np.testing.assert_allclose(value(system.mass, at, p, (2, 2)), value(arms_mass, at, p, (2, 2)), atol=1e-14)
    np.testing.assert_allclose(value(system.force, at, p, 2), value(arms_force, at, p, 2), atol=1e-12)


@settings(deadline=None)
@given(states(1))
def test_pendulum_on_a_shaken_pivot_feels_its_acceleration(at):
    (t, q, _), p = at, values(shaken_pendulum())
    assert value(shaken_pendulum().system.force, at, p, 1) == pytest.approx(
        -(9.81 - 0.1 * 30.0**2 * math.cos(30.0 * t)) * math.sin(q[0]), abs=1e-11
    )


def test_equations_are_those_of_the_textbook():
    m, length, g = sympy.symbols("m length g", positive=True)
    theta, equations = dynamicsymbols("theta"), pendulum().equations
    assert equations.M.tolist() == [[m * length**2]]
    assert equations.N.tolist() == [[0]]
    assert sympy.simplify(equations.F[0] + m * g * length * sympy.sin(theta)) == 0
    x2, _, (theta1, theta2) = tip_and_lagrangian()
    m2, l1, l2 = sympy.symbols("m2 l1 l2")
    coriolis = m2 * l1 * l2 * sympy.sin(theta1 - theta2) * theta2.diff(T) ** 2
    assert sympy.simplify(double_pendulum().equations.N[0] - coriolis) == 0
    assert double_pendulum().equations.gap[0] == x2 + 0.3


def test_gyroscopic_terms_stand_in_the_forces():
    """A charge in a magnetic field B: m x'' = e B y', m y'' = -e B x'."""
    x, y, B = *dynamicsymbols("x y"), sympy.Symbol("B")
    L = (x.diff() ** 2 + y.diff() ** 2) / 2 + B * (x * y.diff() - y * x.diff()) / 2
    charge = derive(L, (x, y), parameters={"B": 3.0})
    np.testing.assert_allclose(
        value(charge.system.force, (0.0, [0.7, 0.1], [1.0, 2.0]), [3.0], 2), [6.0, -3.0]
    )
    assert charge.contacts is None


@pytest.mark.parametrize("mechanism", MECHANISMS)
@settings(deadline=None)
@given(data=st.data())
def test_jacobians_of_the_forces_are_their_derivatives(mechanism, data):
    system, p = mechanism().system, values(mechanism())
    n = system.n_q
    t, q, v = data.draw(states(n))
    by_q = jacobian(lambda x: value(system.force, (t, x, v), p, n), q, STEP)
    by_v = jacobian(lambda x: value(system.force, (t, q, x), p, n), v, STEP)
    np.testing.assert_allclose(value(system.force_q, (t, q, v), p, (n, n)), by_q, rtol=0, atol=1e-10)
    np.testing.assert_allclose(value(system.force_v, (t, q, v), p, (n, n)), by_v, rtol=0, atol=1e-10)


@pytest.mark.parametrize("mechanism", MECHANISMS)
def test_gap_derivatives_are_those_of_the_gap(mechanism):
    contacts, n, p = mechanism().contacts, mechanism().system.n_q, np.array(values(mechanism()))
    t, q, v = 0.35, np.array([1.3, -0.9])[:n], np.array([0.7, -0.2])[:n]
    still, step = np.zeros(n), 1e-3 if mechanism is shaken_pendulum else STEP
    G = value(contacts.jacobian, (t, q, v), p, (contacts.n_c, n))
    by_q = jacobian(lambda x: contacts.state(t, x, still, p)[0], q, STEP)
    np.testing.assert_allclose(G, by_q, rtol=0, atol=1e-12)
    by_t = derivative(lambda s: contacts.state(s, q, still, p)[0], t, step)
    np.testing.assert_allclose(contacts.state(t, q, still, p)[1], by_t, rtol=0, atol=1e-11)
    along = derivative(lambda s: contacts.state(s, q + (s - t) * v, v, p)[1], t, step)
    np.testing.assert_allclose(value(contacts.bias, (t, q, v), p, contacts.n_c), along, rtol=0, atol=1e-10)


def test_gaps_that_do_not_name_the_time_have_no_time_derivative():
    assert pendulum().contacts.gap_t is None
    assert shaken_pendulum().contacts.gap_t is not None


@pytest.mark.parametrize("mechanism", slow(MECHANISMS, MECHANISMS[-1], longest=MECHANISMS[2:-1]))
def test_compiled_callbacks_give_what_plain_ones_give(mechanism):
    system, contacts, p = mechanism().system, mechanism().contacts, values(mechanism())
    random, n, n_c = np.random.default_rng(1), system.n_q, contacts.n_c
    ats = [(random.uniform(0, 5), *random.uniform(-3, 3, (2, n))) for _ in range(20)]
    for f, shape in ((system.force, n), (system.force_q, (n, n)), (contacts.gap, n_c), (contacts.bias, n_c)):
        for at in ats:
            fast, plain = value(_compiled(f), at, p, shape), value(f, at, p, shape)
            np.testing.assert_allclose(fast, plain, rtol=1e-12, atol=1e-12)


@functools.cache
def _compiled(f):
    return numba.njit(f)


# --- motions


@pytest.mark.parametrize(
    ("method", "distance"),
    [
        pytest.param(EventDriven(rtol=1e-11, atol=1e-11), 1e-7, marks=pytest.mark.slow),
        (Moreau(h=1e-3), 1e-10),
    ],
    ids=["events", "moreau"],
)
def test_by_hand_and_from_the_lagrangian_the_motion_is_the_same(method, distance):
    start = [1.0, 0.5], [0.0, 0.0], (0.0, 2.5)
    with warnings.catch_warnings():
        warnings.simplefilter("error")  # both are compiled
        derived = simulate(double_pendulum(0.8).scene(*start), method)
        by_hand = simulate(arms_by_hand(*start, restitution=0.8), method)
    assert len(derived.impacts) == len(by_hand.impacts) > 1
    times = np.linspace(0.0, 2.5, 100)
    np.testing.assert_allclose(derived.at(times)[0], by_hand.at(times)[0], rtol=0, atol=distance)


def test_energy_stays_where_impacts_are_elastic():
    mechanism = double_pendulum()
    run = simulate(mechanism.scene([1.0, 0.5], [0.0, 0.0], (0.0, 5.0)), EXACT)
    assert len(run.impacts) > 2
    energy = mechanism.energy(run.t, run.q, run.v)
    np.testing.assert_allclose(energy, energy[0], rtol=0, atol=1e-9)
    assert energy[0] == pytest.approx(-9.81 * (1.5 * math.cos(1.0) + 0.5 * 0.7 * math.cos(0.5)))


def test_bead_on_a_turning_wire_meets_its_stop_at_the_known_instant():
    """r'' = W^2 r from rest at r0: r = r0 cosh W t."""
    bead, r0 = bead_on_turning_wire(), 0.3
    run = simulate(bead.scene([r0], [0.0], (0.0, 2.0)), EXACT)
    assert run.impacts[0].time == pytest.approx(math.acosh(1.0 / r0) / 2.0, abs=1e-11)
    assert run.impacts[0].before == pytest.approx(-2.0 * math.sqrt(1.0 - r0**2), abs=1e-11)
    free = run.t < run.impacts[0].time
    np.testing.assert_allclose(run.q[free, 0], r0 * np.cosh(2.0 * run.t[free]), rtol=0, atol=1e-11)
    integral = bead.energy(run.t[free], run.q[free], run.v[free])
    np.testing.assert_allclose(integral, -0.5 * 0.2 * (2.0 * r0) ** 2, rtol=0, atol=1e-12)


@pytest.mark.slow
def test_fast_shaking_holds_the_pendulum_upright():
    """Upright is stable for A w > sqrt(2 g l) [Landau, Lifshitz, Mechanics, section 30]."""
    shaken = shaken_pendulum()
    start = {"q0": [math.pi - 0.1], "v0": [0.0], "t_span": (0.0, 10.0)}
    held = simulate(shaken.scene(**start, parameters={"w": 100.0}), EventDriven(rtol=1e-9, atol=1e-9))
    assert np.max(np.abs(held.q - math.pi)) < 0.2
    let_fall = simulate(shaken.scene(**start, parameters={"w": 20.0}), EventDriven(rtol=1e-9, atol=1e-9))
    assert np.max(np.abs(let_fall.q - math.pi)) > 1.0


def test_damping_and_a_force_in_time_give_the_known_oscillation():
    x, (m, c, k, f, w) = dynamicsymbols("x"), sympy.symbols("m c k f w")
    parameters = {"m": 2.0, "c": 0.3, "k": 5.0, "f": 3.0, "w": 1.7}
    L, D = m * x.diff() ** 2 / 2 - k * x**2 / 2, c * x.diff() ** 2 / 2
    oscillator = derive(L, x, parameters=parameters, dissipation=D, forces={x: 1 + f * sympy.cos(w * T)})
    run = simulate(oscillator.scene([0.5], [-1.0], (0.0, 8.0)), EXACT)
    known = driven(2.0, 0.3, 5.0, 1.0, 3.0, 1.7, 0.5, -1.0)
    np.testing.assert_allclose(run.q[:, 0], known(run.t), rtol=0, atol=1e-10)


def test_quadratic_drag_slows_down_as_known():
    """m v' = -c |v| v: v = v0 / (1 + c v0 t / m)."""
    x, c = dynamicsymbols("x"), sympy.Symbol("c")
    v = x.diff()
    body = derive(v**2 / 2, x, parameters={"c": 0.5}, dissipation=c * sympy.Abs(v) ** 3 / 3)
    run = simulate(body.scene([0.0], [3.0], (0.0, 4.0)), EXACT)
    np.testing.assert_allclose(run.v[:, 0], 3.0 / (1.0 + 1.5 * run.t), rtol=0, atol=1e-10)


# --- parameters and constants


def test_parameters_change_without_deriving_again():
    mechanism = double_pendulum()
    start = [0.4, 0.2], [0.0, 0.0], (0.0, 1.0)
    changed = mechanism.scene(*start, parameters={"m2": 2.0}, name="heavy")
    assert changed.system is mechanism.system
    assert changed.parameters == ARMS | {"m2": 2.0}
    assert changed.name == "heavy"
    assert mechanism.parameters == ARMS
    at = 0.0, changed.q0, changed.v0
    np.testing.assert_allclose(
        value(changed.system.mass, at, changed.p, (2, 2)), value(arms_mass, at, changed.p, (2, 2))
    )
    with pytest.raises(ValueError, match=r"^parameters: unknown m3; known are m1, m2"):
        mechanism.scene(*start, parameters={"m3": 1.0})


def test_masses_are_constant_where_they_are_numbers():
    x, y, m = *dynamicsymbols("x y"), sympy.Symbol("m")
    rates = x.diff() ** 2, y.diff() ** 2
    numbers = derive(rates[0] + 1.5 * rates[1] - x * y, (x, y))
    np.testing.assert_array_equal(numbers.system.mass, [[2.0, 0.0], [0.0, 3.0]])
    assert callable(derive(m * rates[0], x, parameters={"m": 1.0}).system.mass)
    scaled = derive(1e9 * rates[0] + 1e-9 * (rates[0] + x.diff() * y.diff() + rates[1]), (x, y))
    assert np.linalg.det(scaled.system.mass) == pytest.approx(4.0)
    theta = dynamicsymbols("theta")
    arm = [sympy.sin(theta), sympy.cos(theta)]
    np.testing.assert_array_equal(derive(sum(z.diff(T) ** 2 for z in arm), theta).system.mass, [[2.0]])


@pytest.mark.parametrize("assumptions", [{}, {"real": True}, {"positive": True}])
def test_plain_symbols_are_as_good_as_functions_of_time(assumptions):
    x, u, k, t = sympy.symbols("x u k t", **assumptions)
    L, Q = u**2 / 2 - k * x**2 / 2, sympy.sin(t)
    plain = derive(L, x, velocities=u, parameters={k: 4.0}, forces=[Q], gaps=x + 1)
    X, U = dynamicsymbols("x u")
    mixed = derive(
        U * X.diff() / 2 - k * X**2 / 2, X, velocities=U, parameters={"k": 4.0}, forces=[Q], gaps=X + 1
    )
    assert plain.source == mixed.source
    assert plain.equations.F[0] == Q - k * x


def test_jumping_expressions_take_the_derivatives_beside_the_jump():
    x = dynamicsymbols("x")
    k, mu = sympy.symbols("k mu")
    spring = sympy.Piecewise((k * x**2 / 2, x < 0), (0, True))
    step = sympy.Heaviside(T - 1) + sympy.Max(x, 0) / 4
    stop = derive(
        x.diff() ** 2 / 2 - spring, x, parameters={"k": 8.0, "mu": 0.5},
        dissipation=mu * sympy.Abs(x.diff()), forces=[step],
    )  # fmt: skip
    p = [8.0, 0.5]
    for t, q, v in [(0.5, -1.0, 2.0), (2.0, -0.5, -1.0), (2.0, 3.0, 1.0), (0.5, 2.0, -1.0)]:
        at = t, np.array([q]), np.array([v])
        force = -8.0 * min(q, 0.0) - 0.5 * np.sign(v) + (t > 1.0) + max(q, 0.0) / 4
        for f in (stop.system.force, _compiled(stop.system.force)):
            assert value(f, at, p, 1) == pytest.approx(force)
        assert value(stop.system.force_q, at, p, (1, 1)) == pytest.approx(-8.0 if q < 0 else 0.25)
        assert value(stop.system.force_v, at, p, (1, 1)) == 0.0
