"""A body that walls hold from all sides: it cannot move, and every wall has a restitution of its own.

Newton's law asks each wall that is struck for a rebound, which not all of them together can give. Impacts without end
take the speed away at once, down to rounding, and the forces are borne; the momentum of both is that of the impulses.
"""

import numpy as np
import pytest

from lagrangian import Coulomb, LinearContacts, LinearSystem, Scene
from lcpstep import EventDriven, Located, Moreau, Status, simulate

METHODS = [EventDriven(), EventDriven(1e-6, 1e-6), Located(0.01), Located(0.01, 4)]


def cage(seed):
    """Normals that add up to zero to the last digit, thrown at."""
    rng = np.random.default_rng(seed)
    n = rng.integers(2, 5)
    n_c = n + 1 + rng.integers(0, 3)
    G = np.round(rng.normal(size=(n_c, n)), 2)
    G[-1] = -G[:-1].sum(0)
    restitution = rng.choice([0.0, 0.3, 0.8, 0.5, 0.95], size=n_c)
    M = np.diag(10.0 ** rng.uniform(-1, 1, n)) if seed % 2 else np.eye(n)
    body = LinearSystem(M=M, force=np.round(rng.normal(size=n) * 5.0))
    walls = LinearContacts(G, restitution=restitution)
    return Scene(body, np.zeros(n), rng.normal(size=n) * 0.2, (0.0, 1.0), contacts=walls)


@pytest.mark.parametrize("method", METHODS, ids=str)
@pytest.mark.parametrize("seed", [9, 14, 15, 17, 19, 40, 56, 82, 122, 154, 217, 412, 579, 678, 1055, 1144])
def test_it_rests_at_once(method, seed):
    scene = cage(seed)
    m = simulate(scene, method)
    assert m.status is Status.DONE, m.message
    np.testing.assert_allclose(m.q, 0.0, rtol=0, atol=1e-12)
    np.testing.assert_allclose(m.v[-1], 0.0, rtol=0, atol=1e-9)
    given = m.impulse.sum(0) @ scene.contacts.G
    taken = scene.system.M @ scene.v0 + np.asarray(scene.system.force.constant) * 1.0
    np.testing.assert_allclose(given, -taken, rtol=0, atol=1e-9 * np.abs(m.impulse).sum())


def rough_cage(seed):
    """The same in the plane with friction, thrown at."""
    rng = np.random.default_rng(seed)
    n_c = 3 + rng.integers(0, 2)
    G = np.round(rng.normal(size=(n_c, 2)), 2)
    G[-1] = -G[:-1].sum(0)
    restitution = rng.choice([0.0, 0.3, 0.8, 0.5, 0.95], size=n_c)
    body = LinearSystem(M=np.eye(2), force=np.round(rng.normal(size=2) * 5.0))
    v0 = rng.normal(size=2) * 0.2
    rubbing = Coulomb(mu=rng.choice([0.0, 0.2, 0.6], size=n_c), tangent=np.stack([-G[:, 1], G[:, 0]], axis=1))
    walls = LinearContacts(G, restitution=restitution, friction=rubbing)
    return Scene(body, np.zeros(2), v0, (0.0, 1.0), contacts=walls)


@pytest.mark.parametrize("h", [1e-2, 1e-3])
@pytest.mark.parametrize("seed", [3, 11, 15, 17, 21, 23, 35, 39])
def test_by_steps_it_rests_too_and_goes_no_further_in_than_a_step_leads(seed, h):
    scene = rough_cage(seed)
    m = simulate(scene, Moreau(h))
    assert m.status is Status.DONE, m.message
    fastest = np.max(np.abs(scene.contacts.G @ scene.v0))
    assert np.min(m.q @ scene.contacts.G.T) >= -2.0 * h * fastest
    force = scene.system.force.constant
    energy = 0.5 * np.sum(m.v**2, axis=1) - m.q @ force
    assert np.all(np.diff(energy) <= h * h * force @ force)  # what the force does within a step
    np.testing.assert_allclose(m.v[-1], 0.0, rtol=0, atol=1e-12)


@pytest.mark.parametrize("method", [EventDriven(), Located(0.01)], ids=str)
@pytest.mark.parametrize("seed", [3, 11, 15, 17, 21, 23, 35, 39, 63])
def test_with_friction_it_rests_at_once(method, seed):
    scene = rough_cage(seed)
    m = simulate(scene, method)
    assert m.status is Status.DONE, m.message
    np.testing.assert_allclose(m.q, 0.0, rtol=0, atol=1e-12)
    given = m.impulse.sum(0) @ scene.contacts.G + m.friction_impulse.sum(0) @ scene.contacts.friction.tangent
    taken = scene.v0 + scene.system.force.constant
    np.testing.assert_allclose(given, -taken, rtol=0, atol=1e-9 * np.abs(m.impulse).sum())
