"""Contacts whose gaps close at one instant strike together, however they are numbered and in whatever units."""

from itertools import combinations, permutations

import numpy as np
import pytest

from lagrangian import Contacts, LinearContacts, LinearSystem, Scene, scenes
from lcpstep import EventDriven, Kind, Located, Status, simulate

ROWS = np.array([[1.0, 0.3], [-0.4, 1.0]])
# A plane that depends on both, and the second once more; each with a restitution of its own
G = np.vstack([ROWS, 0.5 * ROWS[0] + 0.25 * ROWS[1], ROWS[1]])
OFFSET = np.array([0.1, 0.2])
OFFSETS = np.append(OFFSET, [0.5 * 0.1 + 0.25 * 0.2, 0.2])
RESTITUTION = np.array([0.9, 0.2, 0.5, 0.7])


def nothing(t, q, v, p, out):
    """No force, which the library is not told."""
    out[0] = out[1] = 0.0


def corner(order, length=1.0, mass=1.0, force=None):
    """A point that meets all four planes at 0.37 s; lengths and masses in other units."""
    M = mass * np.array([[1.0, 0.2], [0.2, 0.7]])
    q0 = np.linalg.solve(ROWS, np.array([0.37, 0.74]) - OFFSET)
    v0 = np.linalg.solve(ROWS, np.array([-1.0, -2.0]))
    contacts = LinearContacts(G=G[order], offset=length * OFFSETS[order], restitution=RESTITUTION[order])
    system = LinearSystem(M=M, force=force)
    return Scene(system, length * q0, length * v0, (0.0, 0.8), contacts)


def law_of_all(scene):
    """The velocity after 0 <= W p + (1 + r) u-  complementary to  p >= 0 for all planes; all sets are tried."""
    M_inverse, G = np.linalg.inv(scene.system.M), scene.contacts.G
    W, b = G @ M_inverse @ G.T, (1.0 + scene.contacts.restitution) * (G @ scene.v0)
    for k in range(3):
        for pressed in map(list, combinations(range(len(b)), k)):
            p = np.zeros(len(b))
            p[pressed] = np.linalg.lstsq(W[np.ix_(pressed, pressed)], -b[pressed])[0]
            if np.all(p >= 0.0) and np.all(W @ p + b >= -1e-12 * np.abs(b).max()):
                return scene.v0 + M_inverse @ G.T @ p
    raise AssertionError("no solution")


@pytest.mark.parametrize("length", [1.0, 1e3, 0.3048e-3])
@pytest.mark.parametrize("force", [None, nothing], ids=["exact", "integrated"])
@pytest.mark.parametrize("method", [EventDriven, lambda *_: Located(0.01), lambda *_: Located(0.01, 4)])
def test_planes_that_close_together_strike_together(method, force, length):
    for order in permutations(range(4)):
        scene = corner(list(order), length, 1e3, force)
        run = simulate(scene, method(1e-12, 1e-12 * length))
        assert run.status.name == "DONE"
        struck = run.impacts[run.impacts.kind == Kind.IMPACT]
        np.testing.assert_allclose(struck.time, 0.37, rtol=1e-9)
        np.testing.assert_allclose(run.at(0.5)[1], law_of_all(scene), atol=1e-8 * length)


def test_elastic_beads_that_meet_by_threes_pass_through_one_another():
    """The order does not matter to them, and it is taken: with these numbers three beads meet at 0.1657 s."""
    scene = scenes.elastic_gas(100, t_end=0.5)
    run = simulate(scene, EventDriven())
    np.testing.assert_allclose(run.q, scene.exact(run.t)[0], rtol=0, atol=1e-13)


@pytest.mark.parametrize("method", [EventDriven(), Located(0.01), Located(0.01, 4)])
@pytest.mark.parametrize("place", [0.0, 0.1, 1.0 / 3.0])
@pytest.mark.parametrize("v", [(4, 1, -1), (4, 1, -1, -2), (3, 2, 1, 0), tuple(range(20, -20, -3))])
def test_elastic_beads_that_meet_at_one_place_pass_through_whether_rounding_leaves_zero_there(
    v, place, method
):
    """In whole numbers their gaps are zero together, elsewhere they are but nearly so."""
    n, v = len(v), np.array(v, dtype=float)
    contacts = LinearContacts(G=np.diff(np.eye(n), axis=0), restitution=1.0)
    run = simulate(Scene(LinearSystem(M=np.eye(n)), place - v, v, (0.0, 2.0), contacts), method)
    np.testing.assert_allclose(run.v[-1], np.sort(v), rtol=0, atol=1e-12)


@pytest.mark.parametrize("method", [EventDriven(), Located(0.01)])
def test_unlike_beads_that_meet_by_threes_depend_on_no_numbering(method):
    """Two bodies come to a third from both sides; where they meet, rounding cannot tell who is first."""
    after = []
    for order in ([0, 1], [1, 0]):
        contacts = LinearContacts(G=np.array([[-1.0, 1.0, 0.0], [0.0, -1.0, 1.0]])[order], restitution=1.0)
        q0, v0 = (-0.1 * 0.7 / 3.0, 0.0, 0.2 * 0.7 / 3.0), (0.1, 0.0, -0.2)
        scene = Scene(LinearSystem(M=np.diag([1.0, 3.0, 2.0])), q0, v0, (0.0, 1.0), contacts)
        after.append(simulate(scene, method).v[-1])
    np.testing.assert_allclose(after[0], after[1], atol=1e-12)


@pytest.mark.parametrize("first", [0, 1])
def test_planes_that_close_within_the_tolerance_strike_one_after_the_other(first):
    """A gap of 3e-7 is no rounding, whatever the tolerance: here it decides by how much the velocities change."""
    M, G, r = np.array([[1.0, 0.2], [0.2, 0.7]]), ROWS, np.array([0.3, 0.5])
    offset = OFFSET + 3e-7 * (np.arange(2) != first)
    scene = corner([0, 1], force=nothing)
    contacts = LinearContacts(G=G, offset=offset, restitution=r)
    run = simulate(Scene(scene.system, scene.q0, scene.v0, scene.t_span, contacts), EventDriven(1e-6, 1e-6))
    v, M = np.array(scene.v0), 1e3 * M
    for c in [first, 1 - first] * 20:
        if G[c] @ v < -1e-15:
            x = np.linalg.solve(M, G[c])
            v = v - x * (1.0 + r[c]) * (G[c] @ v) / (G[c] @ x)
    np.testing.assert_allclose(run.at(0.37 + 1e-5)[1], v, rtol=0, atol=1e-6)


def neighbours(t, q, v, p, out):
    for c in range(out.shape[0]):
        out[c] = q[c + 1] - q[c]


def their_slopes(t, q, v, p, out):
    out[:] = 0.0
    for c in range(out.shape[0]):
        out[c, c], out[c, c + 1] = -1.0, 1.0


@pytest.mark.parametrize("method", [Located(1e-2), Located(1e-2, order=4), EventDriven()], ids=repr)
@pytest.mark.parametrize("seed", range(6))
def test_elastic_bodies_of_one_mass_that_meet_at_one_point_exchange_their_speeds(seed, method):
    """By gaps in the user's words, too: they leave as if they had passed through each other."""
    g = np.random.default_rng(seed)
    n = int(g.integers(3, 6))
    v = np.sort(np.round(g.uniform(-3.0, 3.0, n), 1) + 0.01 * np.arange(n))[
        ::-1
    ]  # the fastest comes from behind
    contacts = Contacts(n - 1, neighbours, their_slopes, restitution=1.0)
    scene = Scene(LinearSystem(2.5 * np.eye(n)), -0.5 * v, v, (0.0, 1.0), contacts)
    m = simulate(scene, method)
    assert m.status is Status.DONE
    np.testing.assert_allclose(m.v[-1], np.sort(v), rtol=0.0, atol=1e-12)
    assert np.unique(np.round(m.impacts.time, 9)).tolist() == [0.5]
