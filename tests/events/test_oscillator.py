"""The closed-form flow of one linear degree of freedom, for every damping, stiffness and forcing."""

import math

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st
from mpmath import mp, mpf

from lagrangian import Harmonic, LinearSystem, Scene
from lcpstep import EventDriven, simulate
from lcpstep.events.flight.oscillator import fundamental, oscillator
from tests.differences import derivative
from tests.uncompiled import kernels

rates = st.one_of(st.just(0.0), st.floats(-3.0, 3.0).filter(lambda x: abs(x) > 1e-12))
mp.dps = 50
times = st.floats(1e-9, 5.0)
clock, motion = kernels("lcpstep.kernels").clock, kernels("lcpstep.events.flight").motion


def flow(o, t0, y0, w0, tau):
    """Position, velocity and acceleration at t0 + tau of the motion that starts at t0 with y0, w0."""
    s = clock.Clock((t0, t0 + 1.0), [], math.inf)
    s.delta, s.w2, s.f0, s.X, s.Y, s.Omega = o.delta, o.w2, o.f0, o.X, o.Y, o.Omega
    motion.leave_from(s, t0, y0, w0)
    motion.absolute(s, tau)
    return s.y_tau, s.w_tau, s.a_tau


def exact_fundamental(delta, w2, tau):
    """S, S' and the integral of S, by the matrix exponential to fifty digits."""
    A = mp.matrix([[0, 1, 0], [-mpf(w2), -2 * mpf(delta), 0], [1, 0, 0]])
    E = mp.expm(A * mpf(tau))
    return E[0, 1], E[1, 1], E[2, 1]


@pytest.mark.slow
@settings(max_examples=300, deadline=None)
@given(rates, rates, times)
def test_the_fundamental_motion_is_that_of_the_matrix_exponential(delta, w2, tau):
    found, exact = fundamental(delta, w2, tau), exact_fundamental(delta, w2, tau)
    # the size of the two exponentials that S is made of, and the digits lost where it is small beside them
    size = float(mp.exp(max(0, (-delta + math.sqrt(max(delta**2 - w2, 0.0))) * tau)))
    scale = [max(tau, abs(float(exact[0]))), size, max(tau**2, abs(float(exact[2])))]
    for x, y, s in zip(found, exact, scale, strict=True):
        assert abs(float(mpf(x) - y)) <= 5e-14 * max(s, size * s)


@given(st.floats(1e-12, 1e-3), rates, rates)
def test_small_times_lose_no_digits(tau, delta, w2):
    for x, y in zip(fundamental(delta, w2, tau), exact_fundamental(delta, w2, tau), strict=True):
        assert x == pytest.approx(float(y), rel=4e-16 * 4)


@pytest.mark.parametrize("delta", [0.5, 2.0])
@pytest.mark.parametrize("off", [0.0, 1e-15, -1e-15, 1e-12, -1e-12, 1e-9, -1e-9, 1e-6, -1e-6, 1e-3, -1e-3])
@pytest.mark.parametrize("tau", [0.01, 0.3, 3.0])
def test_nearly_equal_exponents_lose_no_digits(delta, off, tau):
    w2 = delta**2 * (1 + off)
    for x, y in zip(fundamental(delta, w2, tau), exact_fundamental(delta, w2, tau), strict=True):
        assert abs(float(mpf(x) - y)) <= 1e-14 * (1 + tau)


forces = st.floats(-2.0, 2.0)


@settings(max_examples=100, deadline=None)
@given(st.floats(0.1, 3.0), st.floats(0.0, 2.0), st.floats(0.0, 5.0), forces, forces, forces, st.floats(0.1, 4.0),
       st.floats(-5.0, 5.0), forces, forces, st.floats(0.0, 4.0))  # fmt: skip
def test_the_flow_obeys_its_equation(m, c, k, constant, cosine, sine, omega, t0, y0, w0, tau):
    # no division by almost nothing: near resonance the flow is handed to Runge-Kutta
    assume(math.hypot(k - m * omega**2, c * omega) > 0.05)
    o = oscillator(m, c, k, constant, cosine, sine, omega)
    y, w, a = flow(o, t0, y0, w0, tau)
    t = t0 + tau
    F = constant + cosine * math.cos(omega * t) + sine * math.sin(omega * t)
    size = 1 + abs(y) + abs(w) + abs(a) + (abs(cosine) + abs(sine)) / 0.05
    assert m * a + c * w + k * y == pytest.approx(F, abs=1e-13 * size * 30)
    # of eighth-order differences: rounding 1e-16/step and truncation (4e-2)^8
    step = 1e-2 / max(1.0, 2 * c / m, math.sqrt(k / m), omega)
    assert derivative(lambda s: flow(o, t0, y0, w0, tau + s)[0], 0.05, step) == pytest.approx(
        flow(o, t0, y0, w0, tau + 0.05)[1], abs=1e-11 * size * max(1.0, 1e-3 / step)
    )
    assert flow(o, t0, y0, w0, 0.0)[:2] == pytest.approx((y0, w0), abs=1e-14 * size)


@pytest.mark.parametrize("c", [0.0, 1e-9])
@pytest.mark.parametrize("off", [0.0, 1e-8, 1e-5, 1e-3])
def test_resonance_is_solved_one_way_or_the_other(c, off):
    omega = 1.0 + off
    scene = Scene(
        system=LinearSystem(M=1.0, C=c, K=1.0, force=Harmonic(cosine=1.0, omega=omega)), q0=0.0, v0=0.0,
        t_span=(0.0, 20.0), period=2 * math.pi / omega,
    )  # fmt: skip
    m = simulate(scene, EventDriven())
    X = 1 / mp.mpc(1 - mpf(omega) ** 2, mpf(c) * mpf(omega)) if (off or c) else None
    for t, q in zip(m.t, m.q[:, 0], strict=True):
        if X is None:
            exact = t * math.sin(t) / 2
        else:
            l1 = mp.mpc(-mpf(c) / 2, mp.sqrt(1 - mpf(c) ** 2 / 4))
            A = (mp.conj(l1) * mp.re(X) - mp.re(X * mp.mpc(0, omega))) / (l1 - mp.conj(l1))
            exact = float(mp.re(X * mp.exp(mp.mpc(0, omega) * t)) + 2 * mp.re(A * mp.exp(l1 * t)))
        # the steady oscillation is 1/(2 off) times larger than the motion; Runge-Kutta has rtol = atol = 1e-12
        assert q == pytest.approx(exact, abs=max(1e-10, 1e-15 / max(off, 1e-6)))


@pytest.mark.parametrize("span", [1e-4, 10.0])
@pytest.mark.parametrize("omega", [1.0, 7.3e-5, 1e-9, 1e-100, 1e-320])
def test_a_slow_force_moves_a_free_body_as_a_constant_one_does(omega, span):
    """The motion was lost in a steady oscillation of F / (m omega^2): of 50 m in 10 s nothing at 1e-9 rad/s."""
    scene = Scene(LinearSystem(M=1.0, force=Harmonic(cosine=1.0, omega=omega)), 0.0, 0.0, (0.0, span))
    half = 0.5 * mpf(omega)
    exact = float(span**2 / mpf(2) * (mp.sin(half * span) / (half * span)) ** 2)
    assert simulate(scene, EventDriven()).q[-1, 0] == pytest.approx(exact, rel=1e-11)


def test_a_free_particle_moves_on_a_parabola_exactly():
    o = oscillator(2.0, 0.0, 0.0, -8.0, 0.0, 0.0, 0.0)
    for tau in (0.0, 0.25, 1.0, 3.0):
        assert flow(o, 0.0, 1.0, 2.0, tau) == (1.0 + 2.0 * tau - 2.0 * tau * tau, 2.0 - 4.0 * tau, -4.0)
    np.testing.assert_array_equal(fundamental(0.0, 0.0, 0.5), [0.5, 1.0, 0.125])
