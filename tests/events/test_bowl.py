"""A ball that bounces in a bowl: impact times are roots of quartics, taken in forty digits.

Between impacts the ball flies on a parabola, and the gap 1 - |q| is a smooth function of time that no polynomial
follows over long hops.
"""

import math
from functools import lru_cache

import numpy as np
import pytest
from mpmath import mp, mpf

from lagrangian import Contacts, LinearSystem, Scene
from lcpstep import EventDriven, simulate
from lcpstep.trajectory import Kind
from tests.marks import shared
from tests.models import bowl_bias, bowl_gap, bowl_jacobian

GRAVITY = 9.81


def ball(q0, v0, restitution, t_end, bias=True, gravity=GRAVITY):
    return Scene(
        system=LinearSystem(M=np.eye(2), force=[0.0, -gravity]),
        contacts=Contacts(
            n_c=1, gap=bowl_gap, jacobian=bowl_jacobian, bias=bowl_bias if bias else None,
            restitution=restitution,
        ),
        q0=q0, v0=v0, t_span=(0.0, t_end), name="ball in a bowl",
    )  # fmt: skip


@lru_cache
def impacts(q0, v0, restitution, n, gravity=GRAVITY):
    """Times of the first n impacts from q0 inside the bowl: first roots of |q + v t + a t^2/2|^2 = 1."""
    with mp.workdps(40):
        a = (mpf(0), -mpf(gravity))
        q, v, t, times = [mpf(x) for x in q0], [mpf(x) for x in v0], mpf(0), []
        for _ in range(n):
            coefficients = [dot(a, a) / 4, dot(v, a), dot(v, v) + dot(q, a), 2 * dot(q, v), dot(q, q) - 1]
            if times:  # on the bowl: one root is zero
                coefficients.pop()
            roots = mp.polyroots(coefficients, maxsteps=500, extraprec=200)
            tau = min(z.real for z in roots if abs(z.imag) < mpf(10) ** -25 and z.real > mpf(10) ** -20)
            t += tau
            times.append(float(t))
            q = [x + w * tau + b * tau**2 / 2 for x, w, b in zip(q, v, a, strict=True)]
            v = [w + b * tau for w, b in zip(v, a, strict=True)]
            size = mp.sqrt(dot(q, q))
            q = [x / size for x in q]
            u = dot(q, v)
            v = [w - (1 + mpf(restitution)) * u * x for w, x in zip(v, q, strict=True)]
        return np.array(times)


def dot(a, b):
    return sum(x * y for x, y in zip(a, b, strict=True))


def random_start(seed):
    random = np.random.default_rng(seed)
    angle, radius = random.uniform(0.0, 2.0 * math.pi), random.uniform(0.0, 0.9)
    q0 = radius * math.cos(angle), radius * math.sin(angle)
    v0 = tuple(float(x) for x in random.choice([0.0, 1.0, 4.0]) * random.normal(size=2))
    return q0, v0, float(random.choice([0.3, 0.6, 0.9, 1.0]))


def check(q0, v0, restitution, t_end, bias, tolerance=1e-11, n=6):
    exact = impacts(q0, v0, restitution, n)
    m = simulate(ball(q0, v0, restitution, t_end, bias), EventDriven(1e-13, 1e-13), keep="impacts")
    found = m.impacts.time[m.impacts.kind == Kind.IMPACT][:n]
    assert len(found) == np.sum(exact < t_end)
    np.testing.assert_allclose(found, exact[: len(found)], rtol=0, atol=tolerance)


@pytest.mark.parametrize("t_end", [3.4, 20.0, 100.0])
@pytest.mark.parametrize(("q0", "restitution"), [((0.5, -0.2), 0.6), ((0.3, 0.1), 0.9)])
def test_impacts_in_the_bowl_are_those_of_the_quartics_whatever_the_span(q0, restitution, t_end):
    check(q0, (0.0, 0.0), restitution, t_end, bias=True)


@pytest.mark.parametrize("seed", range(12))
def test_so_they_are_from_anywhere(seed):
    q0, v0, restitution = random_start(seed)
    for t_end, bias in ((1.5, True), (7.0, False), (60.0, True)):
        check(q0, v0, restitution, t_end, bias)


def test_a_hop_is_seen_whatever_its_gap_does_within_a_long_step():
    """Free flight is one step as long as the scan allows; the gap's speed turns more than once beyond the surface."""
    check(*random_start(197), 1000.0, bias=False)


@pytest.mark.parametrize("seed", shared(range(100, 200), 50))
def test_so_they_are_from_many_more_places(seed):
    q0, v0, restitution = random_start(seed)
    for t_end, bias in ((1.5, True), (7.0, False), (60.0, True), (1000.0, False)):
        check(q0, v0, restitution, t_end, bias)
