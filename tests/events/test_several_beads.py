"""Several contacts under constant forces: gases, blocks, cradles, collapses, piles, by their exact motions."""

from __future__ import annotations

import math

import numpy as np
import pytest

from lagrangian import LinearContacts, LinearSystem, Scene
from lagrangian.scenes import beads, piles
from lcpstep import EventDriven, Kind, Located, Moreau, Status, simulate

GRAVITY = 9.81


def kinetic(m):
    M = np.asarray(m.scene.system.M)
    return 0.5 * np.einsum("ti,ij,tj->t", m.v, M, m.v)


@pytest.mark.parametrize(
    ("n", "t_end", "impacts"),
    [
        pytest.param(12, 2000.0, 100_000, marks=pytest.mark.slow),
        (100, 2.0, 6_000),
        pytest.param(100, 20.0, 65_000, marks=pytest.mark.thorough),
    ],
)
def test_an_elastic_gas_is_free_flight_sorted(n, t_end, impacts):
    rng = np.random.default_rng(n)
    q0, v0 = np.sort(rng.random(n)), rng.uniform(-1.0, 1.0, n)
    scene = beads.line(q0, v0, np.ones(n), 1.0, t_end, "gas", {}, floor=True, ceiling=1.0)
    times = np.linspace(0.0, t_end, 20)
    m = simulate(scene, EventDriven(), keep=times)
    assert m.status is Status.DONE
    assert m.counts.events > 0.5 * impacts
    along = (q0 + times[:, None] * v0) % 2.0
    np.testing.assert_allclose(m.q, np.sort(np.where(along > 1.0, 2.0 - along, along), 1), rtol=0, atol=1e-9)
    np.testing.assert_allclose(kinetic(m), kinetic(m)[0], rtol=1e-12)


@pytest.mark.parametrize("make", [beads.elastic_gas, beads.falling_gas])
def test_beads_that_meet_at_one_place_are_sorted_too(make):
    # the scenes' positions and speeds are in arithmetic progression: whole rows of beads meet at one instant
    scene = make(n=20, t_end=10.0)
    m = simulate(scene, EventDriven(), keep=np.linspace(0.0, 10.0, 50))
    np.testing.assert_allclose(m.q, scene.exact(m.t)[0], rtol=0, atol=1e-11)


@pytest.mark.parametrize("k", [0, 1, 2, 3, 4])
def test_blocks_collide_as_often_as_pi_has_digits(k):
    scene = beads.galperin(k)
    m = simulate(scene, EventDriven(), keep="impacts")
    assert np.sum(m.impacts.kind == Kind.IMPACT) == (3, 31, 314, 3141, 31415)[k]
    np.testing.assert_allclose(kinetic(m), kinetic(m)[0], rtol=1e-10)
    np.testing.assert_allclose(m.q[-1], scene.exact(m.t[-1:])[0][0], rtol=0, atol=1e-8)


@pytest.mark.parametrize("r", [0.0, 0.3, 1.0])
@pytest.mark.parametrize("spacing", [0.0, 1e-9, 1e-3])
def test_a_cradle_shares_the_blow_if_it_touches_and_hands_it_on_if_not(r, spacing):
    scene = beads.newtons_cradle(spacing=spacing, restitution=r)
    m = simulate(scene, EventDriven())
    q, v = scene.exact(m.t[-1:])
    np.testing.assert_allclose(m.v[-1], v[0], rtol=0, atol=1e-14)
    np.testing.assert_allclose(m.q[-1], q[0], rtol=0, atol=1e-14)


CRITICAL = 7.0 - 4.0 * math.sqrt(3.0)


@pytest.mark.parametrize("r", [0.0, 0.01, 0.05, CRITICAL - 1e-3, 0.08, 0.1, 0.5])
def test_three_balls_collapse_below_the_critical_restitution(r):
    scene = beads.inelastic_collapse(restitution=r)
    m = simulate(scene, EventDriven())
    assert m.status is Status.DONE
    assert len(m.impacts) <= 100
    assert np.sum(m.v[-1]) == pytest.approx(0.5, abs=1e-15)
    together = np.ptp(m.v[-1]) < 1e-14
    assert together == (r <= CRITICAL)
    q, _ = scene.exact(m.t[-1:])
    np.testing.assert_allclose(m.q[-1], q[0], rtol=0, atol=1e-12)


@pytest.mark.parametrize(("n", "r"), [(20, 0.5), (20, 0.9), (5, 0.0)])
def test_a_column_comes_to_rest_exactly_and_carries_what_lies_above(n, r):
    m = simulate(beads.column(n=n, restitution=r), EventDriven(), keep="impacts")
    assert m.status is Status.DONE
    energy = kinetic(m) + GRAVITY * m.q.sum(1)
    assert np.max(np.diff(energy)) <= 1e-14 * energy[0]
    gaps = np.diff(m.q, axis=1, prepend=0.0)
    assert gaps.min() > -1e-14
    np.testing.assert_array_equal(m.v[-1], 0.0)
    np.testing.assert_array_equal(m.q[-1], 0.0)
    # all at rest since the last event: force times time
    last = m.impacts.time[-1]
    settled = simulate(beads.column(n=n, restitution=r), EventDriven(), keep=[last + 1.0, last + 2.0])
    np.testing.assert_allclose(settled.impulse[1], beads.weights_above(np.ones(n), GRAVITY), rtol=1e-12)


@pytest.mark.parametrize("load", [0.1, 0.3, -0.47])
@pytest.mark.parametrize("n", [2, 3, 10, 100])
def test_a_block_on_many_feet_rests(n, load):
    m = simulate(piles.block_on_feet(n=n, load=load), EventDriven())
    feet = np.linspace(-0.5, 0.5, n)
    assert np.abs(m.q).max() < 1e-15
    assert np.abs(m.v).max() < 1e-15
    assert m.impulse.min() >= 0.0
    assert m.impulse[-1].sum() == pytest.approx(GRAVITY, rel=1e-13)
    assert m.impulse[-1] @ feet == pytest.approx(load * GRAVITY, rel=1e-12)


def test_a_stack_of_blocks_rests():
    m = simulate(piles.stack(n=10), EventDriven())
    assert np.abs(m.v).max() < 1e-15
    pairs = m.impulse[-1].reshape(10, 2)
    np.testing.assert_allclose(pairs, 0.5 * GRAVITY * np.arange(10, 0, -1)[:, None].repeat(2, 1), rtol=1e-12)


@pytest.mark.parametrize(("ratio", "bound"), [(1e3, 1e-14), (1e9, 1e-14), (1e12, 1e-14)])
def test_a_heavy_block_on_a_light_one_rests(ratio, bound):
    m = simulate(piles.heavy_on_light(ratio=ratio), EventDriven())
    assert np.abs(m.v).max() < 1e-14
    np.testing.assert_allclose(m.impulse[-1], GRAVITY * np.array([1.0 + ratio, ratio]), rtol=bound)


# --- random scenes: invariants, and the time-stepping method in the limit


def random_line(seed, r):
    rng = np.random.default_rng(seed)
    n = 3
    q0 = np.cumsum(rng.uniform(0.1, 0.5, n))
    masses = 10.0 ** rng.uniform(-1, 1, n)
    return beads.line(q0, rng.normal(size=n), masses, r, 2.0, "line", {}, True, 3.0, g=GRAVITY)


@pytest.mark.parametrize("seed", range(6))
def test_no_line_of_beads_gains_energy_or_passes_through_itself(seed):
    rng = np.random.default_rng(100 + seed)
    scene = random_line(seed, rng.uniform(0.0, 1.0, 4))  # another restitution at every contact
    m = simulate(scene, EventDriven())
    assert m.status is Status.DONE
    energy = kinetic(m) + GRAVITY * m.q @ np.diag(np.asarray(scene.system.M))
    assert np.max(np.diff(energy)) <= 1e-13 * energy[0]
    gaps = m.q @ np.asarray(scene.contacts.G).T + np.asarray(scene.contacts.offset)
    assert gaps.min() > -1e-13
    # momentum: impulses, those of resting contacts included, and weight account for every change of velocity
    M = np.asarray(scene.system.M)
    change = (m.v[1:] - m.v[:-1]) @ M + GRAVITY * np.diff(m.t)[:, None] * np.diag(M)
    np.testing.assert_allclose(change, m.impulse[1:] @ np.asarray(scene.contacts.G), rtol=0, atol=1e-12)


def test_moreau_converges_to_it():
    scene = random_line(3, 0.5)
    t = np.linspace(0.0, 1.0, 21)
    exact = simulate(scene, EventDriven()).at(t)[0]
    errors = []
    for h in (1e-3, 1e-4, 1e-5):
        m = simulate(scene, Moreau(h=h), keep=t)
        errors.append(np.mean(np.abs(m.q - exact)))
    assert errors[2] < 0.2 * errors[1] < 0.1 * errors[0]
    assert errors[2] < 1e-4


# --- what has no answer


def squeeze(t, q, v, p, out):
    out[0, 0], out[0, 1], out[0, 2] = 0.1 * t, 0.1, 0.0
    out[1, 0], out[1, 1], out[1, 2] = -0.9 + 0.1 * t, 0.1, 0.0


def test_a_body_squeezed_between_walls_is_refused_by_name():
    # q >= 0.1 t and q <= 0.9 - 0.1 t: nothing fits after t = 4.5
    scene = Scene(
        LinearSystem(M=1.0), [0.3], [0.0], (0.0, 6.0),
        LinearContacts(G=[[1.0], [-1.0]], offset=[0.0, 0.0], restitution=0.0, motion=squeeze),
    )  # fmt: skip
    m = simulate(scene, EventDriven())
    assert m.status is Status.LCP_FAILED
    assert "[0, 1]" in m.message
    assert "t = 4.5" in m.message
    assert np.all(np.isfinite(m.q))
    assert m.t[-1] == pytest.approx(4.5, abs=1e-9)


def test_the_bound_on_events_is_kept_and_says_where():
    m = simulate(beads.column(n=5), EventDriven(max_events=50))
    assert m.status is Status.TOO_MANY_EVENTS
    assert m.counts.events < 80
    assert "max_events = 50" in m.message
    assert "contacts" in m.message


def test_bodies_that_touch_fall_together_whatever_their_masses():
    """Rounding of their weights presses some on each other: no force is needed for that, and none is missing."""
    rng = np.random.default_rng(4)
    for _ in range(40):
        n = int(rng.integers(2, 5))
        scene = beads.line(
            np.full(n, 0.5), np.zeros(n), 10.0 ** rng.uniform(-1.0, 1.0, n), 0.5, 0.3, "stack", {},
            floor=True, g=GRAVITY,
        )  # fmt: skip
        run = simulate(scene, EventDriven(), keep=[0.2])
        assert run.status is Status.DONE
        np.testing.assert_allclose(run.q[0], 0.5 - 0.5 * GRAVITY * 0.04, rtol=1e-14)


@pytest.mark.parametrize("r", [0.3, 0.6])
def test_a_collapse_above_an_elastic_floor_comes_to_rest(r):
    """What the upper contact takes leaves the lower one hops faster than the tolerance, and nothing to end them."""
    scene = Scene(
        LinearSystem(np.eye(2), force=[-GRAVITY, -GRAVITY]), [0.1, 0.15], [0.0, 0.0], (0.0, 2.0),
        LinearContacts([[1.0, 0.0], [-1.0, 1.0]], restitution=[1.0, r]),
    )  # fmt: skip
    run, steps = simulate(scene, EventDriven(max_events=20_000)), simulate(scene, Located(1e-4))
    assert run.status is Status.DONE
    assert not np.any(run.v[-1])
    fast = [m.impacts.time[m.impacts.before < -1e-6][-1] for m in (run, steps)]
    assert abs(fast[0] - fast[1]) < 1e-6


@pytest.mark.parametrize(
    ("masses", "restitution", "q0", "v0"),
    [
        ((0.5, 2.0, 2.0, 0.5), (1.0, 1.0, 0.5, 0.0), (0.0, 0.0, 1.0, 2.0), 2.0),
        ((1.0, 0.5, 3.0), (1.0, 0.5, 0.0), (0.0, 0.5, 1.5), 0.0),
    ],
)
def test_beads_on_each_other_hop_no_longer_on_an_elastic_contact(masses, restitution, q0, v0):
    """Hops of a cluster, as slow as the last ones that were left out, ended the run by their number."""
    n = len(masses)
    scene = Scene(
        LinearSystem(np.diag(masses), force=-GRAVITY * np.array(masses)), q0, np.full(n, v0), (0.0, 4.0),
        LinearContacts(np.eye(n) - np.eye(n, k=-1), restitution=restitution),
    )  # fmt: skip
    run, steps = simulate(scene, EventDriven(max_events=300_000)), simulate(scene, Located(1e-3))
    assert run.status is steps.status is Status.DONE
    assert np.max(np.abs(run.v[-1])) < 1e-12
    times = np.linspace(0.0, 4.0, 100)
    assert np.max(np.abs(run.at(times)[0] - steps.at(times)[0])) < 1e-3
