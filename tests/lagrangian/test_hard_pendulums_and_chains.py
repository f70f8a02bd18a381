"""Exact answers of pendulums, rocking blocks, beads and chains: elliptic functions, collisions counted, energies."""

import math

import numpy as np
import pytest
from mpmath import mp, mpf

from lagrangian import scenes
from lagrangian.scenes import beads, chain
from lagrangian.scenes.double_pendulum import REFERENCE_IMPACTS, REFERENCE_STATES, REFERENCE_TIMES
from lagrangian.scenes.pendulum import stop_times
from lagrangian.scenes.rocking_block import impact_ratio, rocking_times
from tests.lagrangian.reference_double_pendulum import reference

# --- elliptic functions


def test_times_of_the_pendulum_are_elliptic_integrals():
    theta0, w = 1.0, math.sqrt(9.81)
    with mp.workdps(30):
        expected, t = [], mpf(0)
        for j in range(4):
            k = mp.sin(mpf(theta0) / 2) * mpf(0.8) ** j
            t += mp.ellipk(k * k) / mpf(w) * (1 if j == 0 else 2)
            expected.append(float(t))
    np.testing.assert_allclose(stop_times(theta0, w, 0.8, 4), expected, rtol=1e-15)


def test_times_of_the_rocking_block_are_integrals_of_its_energy():
    b, h, theta0 = 0.1, 0.4, 0.15
    alpha, p2, r = math.atan2(b, h), 0.75 * 9.81 / math.hypot(b, h), impact_ratio(b, h)
    times, rates = rocking_times(theta0, alpha, math.sqrt(p2), r, 3)
    energy = lambda x: p2 * (mp.cos(a - x) - mp.cos(a))  # noqa: E731
    with mp.workdps(30):
        a, p2 = mpf(alpha), mpf(p2)
        w, top, t = mp.sqrt(2 * p2 * (mp.cos(a - theta0) - mp.cos(a))), mpf(theta0), mpf(0)
        for j in range(3):
            # t = int dphi / phi', with phi = top - s^2 to take the root out of the end
            half = mp.quad(
                lambda s, top=top: 2 * s / mp.sqrt(4 * p2 * mp.sin(a - top + s * s / 2) * mp.sin(s * s / 2)),
                [0, mp.sqrt(top)],
            )
            t += half * (1 if j == 0 else 2)
            assert times[j] == pytest.approx(float(t), rel=1e-14)
            assert rates[j] == pytest.approx(float(w), rel=1e-14)
            w *= mpf(r)
            top = mp.findroot(lambda x, w=w: w * w / 2 - energy(x), (0, top), solver="anderson")


def test_the_ratio_of_the_rocking_block_conserves_the_moment_about_the_new_corner():
    b, h = 0.1, 0.4
    inertia = (b * b + h * h) / 3  # about the middle
    before, after = inertia + h * h - b * b, inertia + h * h + b * b
    assert impact_ratio(b, h) == pytest.approx(before / after, rel=1e-15)


@pytest.mark.slow
def test_the_double_pendulum_is_that_of_the_series():
    impacts, states = reference(["0.5", "1"], digits=25, order=20)
    np.testing.assert_allclose(np.array(impacts, dtype=float), REFERENCE_IMPACTS[: len(impacts)], rtol=1e-14)
    np.testing.assert_allclose(np.array(states, dtype=float), REFERENCE_STATES[:2], rtol=1e-14)


@pytest.mark.thorough
def test_every_number_of_the_double_pendulum_is_that_of_the_series():
    impacts, states = reference([str(t) for t in REFERENCE_TIMES])
    np.testing.assert_allclose(np.array(impacts, dtype=float), REFERENCE_IMPACTS, rtol=1e-15)
    np.testing.assert_allclose(np.array(states, dtype=float), REFERENCE_STATES, rtol=1e-14)


# --- beads


def collide(q, v, masses, walls, t_end):
    """Elastic collisions one after another, by brute force; the number of them too."""
    q, v, t, count = np.array(q, float), np.array(v, float), 0.0, 0
    while True:
        waits = [(math.inf, -1)]
        for i in range(len(q) - 1):
            if v[i] > v[i + 1]:
                waits.append(((q[i + 1] - q[i]) / (v[i] - v[i + 1]), i))
        if v[0] < 0:
            waits.append(((q[0] - walls[0]) / -v[0], -2))
        if walls[1] is not None and v[-1] > 0:
            waits.append(((walls[1] - q[-1]) / v[-1], -3))
        dt, i = min(waits)
        if t + dt > t_end:
            return q + (t_end - t) * v, v, count
        t, q, count = t + dt, q + dt * v, count + 1
        if i >= 0:
            common = (masses[i] * v[i] + masses[i + 1] * v[i + 1]) / (masses[i] + masses[i + 1])
            v[i], v[i + 1] = 2 * common - v[i], 2 * common - v[i + 1]
        else:
            v[0 if i == -2 else -1] *= -1.0


def test_the_gas_is_the_one_that_collides():
    scene = scenes.elastic_gas(n=7)
    q, v, _ = collide(scene.q0, scene.v0, np.ones(7), (0.0, 1.0), 2.0)
    exact = scene.exact(np.array([2.0]))
    np.testing.assert_allclose(q, exact[0][0], atol=1e-12)
    np.testing.assert_allclose(v, exact[1][0], atol=1e-12)


@pytest.mark.parametrize(("k", "number"), [(0, 3), (1, 31), (2, 314), (3, 3141)])
def test_galperins_blocks_count_the_digits_of_pi(k, number):
    scene = scenes.galperin(k)
    q, v, counted = collide(scene.q0, scene.v0, [1.0, 100.0**k], (0.0, None), scene.t_span[1])
    assert counted == number == beads.collisions(k)
    exact = scene.exact(np.array([scene.t_span[1]]))
    np.testing.assert_allclose(q, exact[0][0], rtol=1e-8)
    np.testing.assert_allclose(v, exact[1][0], rtol=1e-8, atol=1e-9)


def test_more_digits_of_pi():
    assert [beads.collisions(k) for k in (4, 5, 6, 7, 8)] == [31415, 314159, 3141592, 31415926, 314159265]


@pytest.mark.parametrize("r", [0.0, 0.5, 1.0])
def test_the_touching_cradle_obeys_newtons_law_at_both_contacts(r):
    _, v = scenes.newtons_cradle(restitution=r).exact(np.array([1.0]))
    u_before, u_after = np.array([-1.0, 0.0]), np.diff(v[0])
    impulses = np.array([1.0 - v[0, 0], v[0, 2]])
    assert np.all(impulses > 0)
    np.testing.assert_allclose(u_after, -r * u_before, atol=1e-15)
    assert np.sum(v[0]) == pytest.approx(1.0, rel=1e-15)


def test_infinitely_many_impacts_exactly_below_the_threshold():
    threshold = 7.0 - 4.0 * math.sqrt(3.0)
    for r, collapses in ((0.99 * threshold, True), (1.2 * threshold, False)):
        scene = scenes.inelastic_collapse(restitution=r)
        _, v = scene.exact(np.array([1e6]))
        assert np.sum(v[0]) == pytest.approx(np.sum(scene.v0), abs=1e-14)
        assert (np.ptp(v[0]) == 0.0) == collapses
        assert np.all(np.diff(v[0]) >= 0.0)


def test_weights_add_up_from_the_top():
    np.testing.assert_array_equal(beads.weights_above([3.0, 2.0, 1.0], 10.0), [60.0, 30.0, 10.0])


# --- the chain


@pytest.mark.parametrize("n", [2, 10, 40])
def test_the_chain_keeps_its_energy_after_the_impact_and_leaves_where_the_force_vanishes(n):
    scene = scenes.elastic_chain(n=n)
    masses, K = chain.chain_matrices(n)
    times = np.linspace(0.0, 4.0, 801)
    q, v = scene.exact(times)
    energy = 0.5 * (v**2 @ masses) + 0.5 * np.einsum("ti,ij,tj->t", q, K, q)
    assert energy[0] == pytest.approx(0.5, rel=1e-12)
    np.testing.assert_allclose(energy[times > 0.1001], 0.5 - 0.5 * masses[0], rtol=1e-11)
    assert len(scene.exact.impacts) == len(scene.exact.releases) == 1
    force = scene.exact.force(np.array([scene.exact.releases[0] - 1e-9]))
    assert 0.0 <= force[0] < 1e-6


@pytest.mark.slow
def test_a_fine_chain_presses_like_a_bar():
    scene = scenes.elastic_chain(n=200)
    force = scene.exact.force(np.linspace(0.3, 1.9, 400))
    assert np.mean(force) == pytest.approx(1.0, abs=0.01)
    scene.exact(np.array([2.5]))
    assert scene.exact.releases[0] - 0.1 == pytest.approx(2.0, abs=0.02)
