"""Coordinates that mix bodies which do not touch: what acts between these is rounding, and decides nothing."""

import numpy as np
import pytest

from lagrangian import Coulomb, LinearContacts, LinearSystem, Scene
from lcpstep import EventDriven, Located, Moreau, Status, simulate
from tests.random_slopes import draw

TURNS = 12


def turned(scene, seed):
    """The scene in other coordinates, and the matrix that brings these back."""
    Q, _ = np.linalg.qr(np.random.default_rng(seed).normal(size=(scene.n_q, scene.n_q)))
    c, M = scene.contacts, Q.T @ scene.system.M @ Q
    rubbing = Coulomb(c.friction.mu, c.friction.tangent @ Q, mu_s=c.friction.mu_s)
    return Scene(
        LinearSystem(0.5 * (M + M.T), force=Q.T @ scene.system.force.constant), Q.T @ scene.q0, Q.T @ scene.v0,
        scene.t_span, LinearContacts(c.G @ Q, c.offset, c.restitution, friction=rubbing),
    ), Q  # fmt: skip


@pytest.mark.parametrize("method", [EventDriven(), Located(0.01), Located(0.01, order=4)], ids=str)
@pytest.mark.parametrize("seed", [25, 43, 85])
def test_a_body_that_slides_leaves_the_landing_of_another_alone(seed, method):
    """Two or three slide at rest on their slopes as others land: no impulses were found in a third of all turns."""
    scene = draw(seed)
    end = scene.t_span[1]
    straight = simulate(scene, method, keep=[end])
    for k in range(TURNS):
        other, Q = turned(scene, k)
        run = simulate(other, method, keep=[end])
        assert run.status is Status.DONE, run.message
        np.testing.assert_allclose(Q @ run.q[-1], straight.q[-1], rtol=0.0, atol=1e-8)


def test_a_body_that_sticks_is_not_let_go_by_the_landing_of_another():
    """Friction of a blow is that of sliding, less than what holds: it let go of the first point for good."""
    scene, method = draw(44), Moreau(0.01)
    straight = simulate(scene, method)
    for k in range(TURNS):
        other, Q = turned(scene, k)
        run = simulate(other, method)
        np.testing.assert_allclose(run.q @ Q.T, straight.q, rtol=0.0, atol=1e-8)


def stretched(scene, seed):
    """The scene in coordinates that are far from orthogonal ones, and the matrix that brings these back."""
    rng, n = np.random.default_rng(seed), scene.n_q
    U, W = (np.linalg.qr(rng.normal(size=(n, n)))[0] for _ in range(2))
    B = np.linalg.inv(U @ np.diag(10.0 ** rng.uniform(-1, 1, n)) @ W)
    c, M = scene.contacts, B.T @ scene.system.M @ B
    rubbing = Coulomb(c.friction.mu, c.friction.tangent @ B, mu_s=c.friction.mu_s)
    q0, v0 = np.linalg.solve(B, scene.q0), np.linalg.solve(B, scene.v0)
    system = LinearSystem(0.5 * (M + M.T), force=B.T @ scene.system.force.constant)
    contacts = LinearContacts(c.G @ B, c.offset, c.restitution, friction=rubbing)
    return Scene(system, q0, v0, scene.t_span, contacts), B


@pytest.mark.parametrize("seed", [7, 14, 23])
def test_what_cancels_in_skew_coordinates_is_as_small_as_its_terms_allow(seed):
    """A plastic impact took the place of one of which no impulses were found: 2e-2 m off, and nothing was said."""
    scene, method = draw(153), EventDriven(1e-11, 1e-11)
    other, B = stretched(scene, seed)
    end = scene.t_span[1]
    one, two = (simulate(s, method, keep=[end]).q[-1] for s in (scene, other))
    np.testing.assert_allclose(B @ two, one, rtol=0.0, atol=1e-8)
