"""What comes to several obstacles at one instant strikes them together, whatever rounding makes of that instant."""

import functools

import numpy as np
import pytest

from lagrangian import LinearContacts, LinearSystem, Scene
from lcpstep import EventDriven, Located, Moreau, simulate

OMEGA, AMPLITUDE = 13.0, 0.03


def table(t, q, v, p, out):
    s, c = AMPLITUDE * np.sin(OMEGA * t), AMPLITUDE * np.cos(OMEGA * t)
    for k in range(2):
        out[k, 0], out[k, 1], out[k, 2] = s, OMEGA * c, -OMEGA * OMEGA * s


def feet(periods):
    """A body above the table, its height and its tilt, with feet of two restitutions."""
    start = periods * 2.0 * np.pi / OMEGA
    contacts = LinearContacts([[1.0, -0.5], [1.0, 0.5]], restitution=[1.0, 0.5], motion=table)
    system = LinearSystem(M=np.diag([1.0, 0.231]), force=(-9.81, 0.0))
    return Scene(system=system, contacts=contacts, q0=(0.1, 0.0), v0=(0.0, 0.0), t_span=(start, start + 0.3))


METHODS = [
    EventDriven(), EventDriven(1e-6, 1e-6), Located(0.01), Located(0.01, 4), Located(0.02, tolerance=1e-5),
    Located(0.02, 4, tolerance=1e-7),
]  # fmt: skip


@pytest.mark.parametrize("method", METHODS, ids=str)
def test_feet_strike_together_a_day_from_zero_too(method):
    near = simulate(feet(0), EventDriven())
    first = near.impacts[:2]
    for periods in (0, 1, 10**3, 10**4, 123_456, 2 * 10**5):
        struck = simulate(feet(periods), method).impacts[:2]
        assert set(struck["contact"]) == {0, 1}
        for c in (0, 1):
            own, other = struck[struck["contact"] == c][0], first[first["contact"] == c][0]
            np.testing.assert_allclose(own["after"], other["after"], atol=1e-4)


def corner(seed, before):
    """A point in the corner of some walls, or on its way to all of them, and the speeds of their gaps."""
    rng = np.random.default_rng(seed)
    n, k = int(rng.integers(2, 5)), int(rng.integers(2, 5))
    G, A, v0 = rng.normal(size=(k, n)), rng.normal(size=(n, n)), 2.0 * rng.normal(size=n)
    restitution, force = rng.uniform(0.1, 0.9, k), 3.0 * rng.normal(size=n)
    if before > 0.0:
        G, force = -np.sign(G @ v0)[:, None] * G, np.zeros(n)
    system = LinearSystem(A @ A.T + np.eye(n), force=force)
    walls = LinearContacts(G, restitution=restitution)
    return Scene(system, -before * v0, v0, (0.0, 0.5), contacts=walls), G @ v0


# Where walls in their turn are struck by the body that comes from others; seeds: of such scenes
@pytest.mark.parametrize("method", [Located(1e-3), Located(1e-2, 4), Located(1e-2, "exact")], ids=str)
@pytest.mark.parametrize("seed", [10, 46, 48, 76, 122, 124, 166, 183, 231, 271, 316])
def test_walls_of_a_corner_strike_together_from_its_apex_on(seed, method):
    """One and the same instant, as far as it goes: no wall has been left, nor is one further away than another."""
    scene, _ = corner(seed, 0.0)
    expected, run = (simulate(scene, m, keep=[0.5]) for m in (EventDriven(), method))
    np.testing.assert_allclose(run.q, expected.q, rtol=0, atol=1e-8)


@functools.cache
def struck_by_steps():
    """Corners met at speeds that differ, and what becomes of the motion by steps, which strike all walls together."""
    tried = ((seed, *corner(seed, 0.1)) for seed in range(300))
    scenes = [(seed, scene) for seed, scene, u in tried if 1e-3 < np.max(u) / np.min(u) < 0.1]
    return [(seed, scene, simulate(scene, Moreau(1e-5), keep=[0.5]).q) for seed, scene in scenes]


@pytest.mark.parametrize("method", [Located(1e-3), Located(1e-2, 4), EventDriven()], ids=str)
def test_a_corner_is_struck_as_one_whatever_the_speeds_of_its_walls(method):
    assert len(struck_by_steps()) > 20
    for seed, scene, end in struck_by_steps():
        run = simulate(scene, method, keep=[0.5])
        np.testing.assert_allclose(run.q, end, rtol=0, atol=1e-3, err_msg=str(seed))


def still(t, q, v, p, out):
    """A table that might move, and does not."""
    out[:, :] = 0.0


@pytest.mark.parametrize(
    "method", [EventDriven(), Located(1e-2), Located(1e-3), Located(2e-4), Located(1e-3, 4)]
)
@pytest.mark.parametrize("masses", [(1.1, 0.7), (0.9, 1.7, 0.4), (0.31, 1.3, 1.9, 0.77)])
def test_bodies_that_fly_together_land_together(masses, method):
    """As one ball. What rounding left of their relative speed parted them on top, where their own speeds vanish."""
    n, r, height = len(masses), 0.9, 0.2
    contacts = LinearContacts(np.eye(n) - np.eye(n, k=-1), restitution=[r] + [0.6] * (n - 1), motion=still)
    system = LinearSystem(np.diag(masses), force=-9.81 * np.array(masses))
    scene = Scene(system, np.full(n, height), np.zeros(n), (0.0, 1.5), contacts)
    fall = np.sqrt(2.0 * height / 9.81)
    times = fall * (1.0 + 2.0 * np.cumsum([0.0, r, r**2, r**3, r**4]))
    run = simulate(scene, method)
    np.testing.assert_allclose(run.impacts.time[run.impacts.contact == 0], times, rtol=0.0, atol=1e-10)
    np.testing.assert_allclose(np.diff(run.q, axis=1), 0.0, rtol=0.0, atol=1e-12)


@pytest.mark.parametrize("restitution", [1.0, (0.5, 1.0, 0.0), (1.0, 1.0, 0.5)], ids=str)
@pytest.mark.parametrize("inertia", [0.1, 0.25])
@pytest.mark.parametrize(
    "method", [Located(2e-3), Located(2e-3, 4), Located(1e-3, 4), EventDriven()], ids=str
)
def test_a_block_that_falls_flat_on_three_feet_does_not_tumble(method, inertia, restitution):
    contacts = LinearContacts([[1.0, -0.5], [1.0, 0.0], [1.0, 0.5]], restitution=restitution)
    system = LinearSystem(M=np.diag([1.0, inertia]), force=(-9.81, 0.0))
    run = simulate(Scene(system, (0.1, 0.0), (0.0, 0.0), (0.0, 4.0), contacts=contacts), method)
    assert np.max(np.abs(run.q[:, 1])) < 1e-13
    if restitution == 1.0:  # as one body bounces, every 2 sqrt(2 0.1 / g)
        since = np.mod(run.t + np.sqrt(0.2 / 9.81), 2.0 * np.sqrt(0.2 / 9.81)) - np.sqrt(0.2 / 9.81)
        np.testing.assert_allclose(run.q[:, 0], 0.1 - 0.5 * 9.81 * since**2, rtol=0, atol=1e-11)
