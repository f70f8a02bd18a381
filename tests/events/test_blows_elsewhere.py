"""Contacts at rest that stick by mu_s alone, and blows elsewhere, which do not reach them."""

import numpy as np
import pytest
from scipy import sparse

from lagrangian import Coulomb, LinearContacts, LinearSystem, Scene
from lcpstep import EventDriven, Located, Moreau, Status, simulate
from lcpstep.trajectory import Kind

EVENTS = [EventDriven(), Located(1e-2), Located(1e-2, order=4), Located(1e-2, tolerance=1e-8)]
STEPS = [Moreau(1e-3), Moreau(1e-2, tolerance=1e-4)]


def blocks(kind, angle):
    """Two blocks, each thrown onto a slope of its own, where mu_s holds it and mu would not; the second one later."""
    c, s = np.cos(angle), np.sin(angle)
    mu, weight = 0.9 * s / c, 9.81
    G = np.array([[-s, c, 0, 0], [0, 0, -s, c]])
    T = np.array([[c, s, 0, 0], [0, 0, c, s]])
    return Scene(
        LinearSystem(kind(np.diag([0.57, 0.57, 2.36, 2.36])), force=[0, -0.57 * weight, 0, -2.36 * weight]),
        q0=[0.0, 0.3, 0.0, 2.0], v0=[0.3 * s, 0.3 * c, 0.1, 0.0], t_span=(0.0, 1.5),
        contacts=LinearContacts(kind(G), friction=Coulomb(mu, kind(T), mu_s=1.3 * mu)),
    )  # fmt: skip


@pytest.mark.parametrize("angle", [0.33, 0.47])
@pytest.mark.parametrize("method", [*EVENTS, *STEPS])
def test_a_blow_that_does_not_reach_it_lets_nothing_slip(method, angle):
    """The first block lies still when the second one strikes, and goes on lying there."""
    run = simulate(blocks(np.asarray, angle), method, keep=[0.55, 1.5])
    log = run.impacts[run.impacts.time > 0.55]
    assert run.status is Status.DONE
    assert np.any((log.contact == 1) & (log.kind == Kind.IMPACT))
    assert not np.any((log.contact == 0) & (log.kind == Kind.SLIP))
    np.testing.assert_allclose(run.q[1, :2], run.q[0, :2], rtol=0, atol=1e-12)


@pytest.mark.usefixtures("sparse_steps")
def test_nor_in_sparse_steps():
    run = simulate(blocks(sparse.csr_array, 0.47), Moreau(1e-2), keep=[0.55, 1.5])
    np.testing.assert_allclose(run.q[1, :2], run.q[0, :2], rtol=0, atol=1e-12)


@pytest.mark.parametrize("method", [EventDriven(), Located(1e-2, order=4), Located(1e-2)])
def test_a_blow_that_leaves_no_sliding_lets_nothing_slip(method):
    """Two bodies that share a mass; the one that sticks by mu_s is struck through it, and its impulses cancel."""
    mass = [
        [6.88, 0.91, -0.08, 0.26], [0.91, 2.83, 0.07, 0.2], [-0.08, 0.07, 4.38, -1.61], [0.26, 0.2, -1.61, 5.26]
    ]  # fmt: skip
    rubbing = Coulomb([0.64, 0.41], [[0.98, -0.21, 0, 0], [0, 0, 0.91, -0.42]], mu_s=[0.83, 0.54])
    scene = Scene(
        LinearSystem(mass, force=[-1.07, -27.74, 0.56, -51.62]), [0.0, 1.81, 0.0, 1.53], [-0.46, 2.58, -4.19, 0.03],
        (0.0, 2.0), LinearContacts([[0.21, 0.98, 0, 0], [0, 0, 0.42, 0.91]], friction=rubbing),
    )  # fmt: skip
    run = simulate(scene, method, keep=[0.6, 2.0])
    log = run.impacts[run.impacts.time > 0.6]
    assert set(log.contact[log.kind == Kind.IMPACT]) == {0, 1}
    assert not np.any(log.kind == Kind.SLIP)
    np.testing.assert_allclose(run.q[1, 2:], run.q[0, 2:], rtol=0, atol=1e-12)
