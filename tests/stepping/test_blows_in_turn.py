"""Blows that follow one another within a step or two: what one makes approach again is struck anew, at any h."""

import numpy as np
import pytest
from scipy import sparse

from lagrangian import Coulomb, LinearContacts, LinearJoints, LinearSystem, Scene, scenes
from lcpstep import EventDriven, Moreau, Status, energy, simulate
from lcpstep.lcp.saddle import Problem
from lcpstep.stepping.sparse.equations import Equations, Step

MASSES, RESTITUTION, SPEED, NEAR = np.array([0.3, 2.0, 1.0, 5.0]), np.array([0.8, 0.6, 0.7]), 1.5, 1e-8


def after_all_blows(masses=MASSES, restitution=RESTITUTION, speed=SPEED, near=NEAR):
    """Velocities of beads that the first one has run into, from one pair that meets to the next, and how many met."""
    v, gap, blows = np.zeros(len(masses)), np.full(len(masses) - 1, near), 0
    v[0], gap[0] = speed, 0.0
    while np.any(np.diff(v) < -1e-14):
        closing = np.diff(v)
        left = np.divide(gap, -closing, out=np.full(len(gap), np.inf), where=closing < 0.0)
        k = int(np.argmin(left))
        gap += closing * left[k]
        gap[k] = 0.0
        p = -(1.0 + restitution[k]) * closing[k] / (1.0 / masses[k] + 1.0 / masses[k + 1])
        v[k : k + 2] += (-p / masses[k], p / masses[k + 1])
        blows += 1
    return v, blows


def beads(way=""):
    """These beads, the first 0.1 m before the others; `way` of asking for the same motion."""
    n = len(MASSES)
    M, G, q0, v0, extra = np.diag(MASSES), np.diff(np.eye(n), axis=0), np.zeros(n), np.zeros(n), {}
    offset = np.full(n - 1, NEAR)
    offset[0], v0[0] = 0.1, SPEED
    friction = None
    if "friction" in way:  # each may move to the side too, and none does
        M, q0, v0 = np.kron(np.eye(2), M), np.zeros(2 * n), np.append(v0, np.zeros(n))
        G, tangent = np.kron([[1.0, 0.0]], G), np.kron([[0.0, 1.0]], G)
        friction = Coulomb(0.4, sparse.csr_array(tangent) if "sparse" in way else tangent)
    if "joint" in way:  # the third one is made of two
        M, q0, v0 = np.diag([0.3, 2.0, 0.4, 5.0, 0.6]), np.zeros(5), np.append(v0, 0.0)
        G, extra = np.column_stack([G, np.zeros(3)]), {"joints": LinearJoints([[0.0, 0.0, 1.0, 0.0, -1.0]])}
    if "sparse" in way:
        M, G = sparse.csr_array(M), sparse.csr_array(G)
    contacts = LinearContacts(G, offset, RESTITUTION, friction=friction)
    return Scene(LinearSystem(M), q0, v0, (0.0, 0.4), contacts, **extra)


def test_the_beads_meet_more_often_than_once_each():
    assert after_all_blows()[1] > len(RESTITUTION) + 1


@pytest.mark.usefixtures("sparse_steps")
@pytest.mark.parametrize("h", [1e-2, 1.3e-3])
@pytest.mark.parametrize("way", ["", "friction", "joint", "sparse", "sparse friction"])
def test_beads_that_nearly_touch_leave_as_after_one_blow_after_another(way, h):
    run = simulate(beads(way), Moreau(h))
    expected, _ = after_all_blows()
    np.testing.assert_allclose(run.v[-1][: len(MASSES)], expected, rtol=0, atol=1e-12)
    assert np.min(np.diff(np.eye(len(MASSES)), axis=0) @ run.q[:, : len(MASSES)].T) > -0.1 - 3.0 * h * SPEED
    assert len(energy(run).created) == 0


@pytest.mark.parametrize(
    "method", [Moreau(1e-3, 1.0), Moreau(1e-3, lcp="qp"), Moreau(0.05, tolerance=1e-6)], ids=str
)
def test_every_way_of_stepping_has_the_same_blows(method):
    expected, _ = after_all_blows()
    np.testing.assert_allclose(simulate(beads(), method).v[-1], expected, rtol=0, atol=1e-6)


@pytest.mark.parametrize("projected", [False, True])
def test_beads_collapse_within_a_step_as_they_do_in_time(projected):
    scene = scenes.inelastic_collapse()
    end = simulate(scene, EventDriven()).v[-1]
    run = simulate(scene, Moreau(np.ptp(scene.t_span) / 1000, projected=projected))
    np.testing.assert_allclose(run.v[-1], end, rtol=0, atol=1e-12)


def test_a_pile_of_all_masses_comes_to_rest_where_it_lies():
    n, rng = 12, np.random.default_rng(5)
    M = 10.0 ** rng.uniform(-1.0, 1.0, n)
    G = np.vstack([np.eye(n)[0], np.diff(np.eye(n), axis=0)])
    scene = Scene(
        LinearSystem(np.diag(M), force=-9.81 * M), 0.05 * np.arange(1, n + 1), np.zeros(n), (0.0, 2.0),
        LinearContacts(G, restitution=0.4),
    )  # fmt: skip
    run = simulate(scene, Moreau(2e-3))
    assert np.max(np.abs(run.v[-1])) < 1e-12
    assert np.min(run.q @ G.T) > -20.0 * 2e-3
    E = (0.5 * run.v**2 + 9.81 * run.q) @ M
    gain = 0.6 / (8.0 * 1.4) * np.sum(M) * (9.81 * 2e-3) ** 2  # of a step, at most: docs/large-systems.md
    assert np.max(np.diff(E)) < gain
    assert run.counts.lcp_calls < 20 * run.counts.steps


@pytest.mark.parametrize(("gap", "stiffness", "seed"), [(1e-3, 30.0, 1), (1e-3, 300.0, 0), (3e-4, 300.0, 2)])
def test_what_falls_onto_a_pile_at_rest_is_struck_beside_the_rounding_of_its_rates(gap, stiffness, seed):
    n, h = 14, 1e-4
    G, v0 = np.eye(n) - np.eye(n, k=-1), 0.2 * np.random.default_rng(seed).normal(size=n)
    system = LinearSystem(np.eye(n), K=stiffness * (G[1:].T @ G[1:]), force=np.full(n, -9.81))
    scene = Scene(system, gap * np.arange(1, n + 1), v0, (0.0, 0.06), LinearContacts(G, restitution=0.4))
    run = simulate(scene, Moreau(h), keep=20)
    assert run.status.name == "DONE"
    assert np.min(run.q @ G.T) > -2.0 * h * np.max(np.abs(run.v))  # nothing falls through what it strikes
    E = 0.5 * np.sum(run.v**2 + run.q * (run.q @ system.K), axis=1) + 9.81 * np.sum(run.q, axis=1)
    assert np.max(np.diff(E)) < 1e-6 * E[0]


def test_asking_a_sparse_step_whether_blows_follow_keeps_the_factors_of_its_contacts():
    step = Step(Equations(beads("sparse")), 1e-2, 0.5)
    n, rates = len(RESTITUTION), -np.ones(len(RESTITUTION))
    problem, none = Problem(np.zeros(n + 1), rates, np.ones(n), np.ones(n, dtype=bool)), np.zeros(n)
    first = step.saddle.solve(problem, rates < 0.0, none)
    factorised = step.saddle.systems
    np.testing.assert_allclose(step.saddle.free(MASSES), 1.0, rtol=0, atol=1e-15)
    again = step.saddle.solve(problem, first.z > 0.0, none)
    assert step.saddle.systems == factorised > 0
    np.testing.assert_array_equal(first.z, again.z)


def rising(t, q, v, p, out):
    out[:] = 0.0
    out[0, 0], out[0, 1] = 3.0 * t, 3.0


def between_table_and_ceiling(restitution, way=""):
    """Three beads on a table that rises to the ceiling, from 0.7 m below it, in 0.2 s: they fill it after 0.2 s."""
    G = np.array([[1.0, 0.0, 0.0], [-1.0, 1.0, 0.0], [0.0, -1.0, 1.0], [0.0, 0.0, -1.0]])
    M, q0, v0, f, T, extra = (
        np.diag([1.0, 1.0, 0.5]),
        [0.1, 0.2, 0.3],
        np.zeros(3),
        [0.0, -0.1, 0.2],
        None,
        {},
    )
    if "friction" in way:  # they move to the side too
        G, T = np.kron([[1.0, 0.0]], G), np.kron([[0.0, 1.0]], G)
        M, q0, v0, f = (
            np.kron(np.eye(2), M),
            [*q0, *np.zeros(3)],
            np.append(v0, [0.1, 0.0, -0.2]),
            [*f, *np.zeros(3)],
        )
    if "joint" in way:  # the last one is made of two
        M, q0, v0, f = np.diag([1.0, 1.0, 0.2, 0.3]), [*q0, 0.3], np.zeros(4), [*f, 0.0]
        G, extra = np.column_stack([G, np.zeros(4)]), {"joints": LinearJoints([[0.0, 0.0, 1.0, -1.0]])}
    if "sparse" in way:
        M, G, T = sparse.csr_array(M), sparse.csr_array(G), None if T is None else sparse.csr_array(T)
    friction = None if T is None else Coulomb(0.3, T)
    contacts = LinearContacts(G, [0.0, 0.0, 0.0, 0.6], restitution, motion=rising, friction=friction)
    return Scene(LinearSystem(M, force=f), q0, v0, (0.0, 0.5), contacts, **extra)


@pytest.mark.usefixtures("sparse_steps")
@pytest.mark.parametrize("restitution", [0.3, 0.8])
@pytest.mark.parametrize(
    ("way", "method"),
    [
        *(
            (way, Moreau(1e-3))
            for way in ("", "friction", "joint", "sparse", "sparse friction", "sparse joint")
        ),
        *((way, Moreau(1e-2, tolerance=1e-3)) for way in ("", "friction", "joint")),
    ],
    ids=str,
)
def test_a_table_that_leaves_no_room_below_the_ceiling_ends_the_run(way, method, restitution):
    """Blows to and fro that the table feeds have no end; the beads were driven through the ceiling in silence."""
    run = simulate(between_table_and_ceiling(restitution, way), method)
    assert run.status is Status.LCP_FAILED
    assert "approach each other with nothing left between" in run.message
    assert run.t[-1] == pytest.approx(0.2, abs=2.5e-3)


@pytest.mark.usefixtures("sparse_steps")
@pytest.mark.parametrize("way", ["", "sparse"])
def test_a_light_body_keeps_heavy_ones_apart_that_close_in(way):
    """They meet it so often that no step has the blows for it; at last all three go on together."""
    masses, G = np.array([100.0, 1e-4, 1000.0]), np.diff(np.eye(3), axis=0)
    M, G = (sparse.diags_array(masses), sparse.csr_array(G)) if way else (np.diag(masses), G)
    contacts = LinearContacts(G, np.array([0.05, 0.02]), restitution=0.5)
    scene = Scene(LinearSystem(M), [0.0, 0.0, 0.0], [1.0, 0.0, 0.0], (0.0, 0.5), contacts)
    together = 100.0 / np.sum(masses)
    for h in (1e-2, 1e-3):
        m = simulate(scene, Moreau(h))
        assert m.status is Status.DONE
        np.testing.assert_allclose(m.v[-1], together, rtol=1e-9)
        assert np.min(m.q[:, 2] - m.q[:, 0]) > -0.07 - 2.0 * h
