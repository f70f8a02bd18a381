"""What the theta-method does to the energy."""

import numpy as np
import pytest

from lagrangian import LinearContacts, LinearSystem, Scene
from lcpstep import Moreau, simulate

M = np.array([[2.0, 0.3, 0.0], [0.3, 1.0, 0.1], [0.0, 0.1, 0.5]])
K = np.array([[40.0, -10.0, 0.0], [-10.0, 30.0, -5.0], [0.0, -5.0, 20.0]])


def chain(t_end, contacts=None):
    return Scene(
        system=LinearSystem(M=M, K=K), q0=[0.3, -0.2, 0.5], v0=[1.0, 0.0, -1.0], t_span=(0.0, t_end),
        contacts=contacts,
    )  # fmt: skip


def energy(m):
    return 0.5 * np.einsum("ti,ij,tj->t", m.v, M, m.v) + 0.5 * np.einsum("ti,ij,tj->t", m.q, K, m.q)


def test_one_half_keeps_the_energy_of_a_linear_system_to_rounding():
    steps = 1_000_000
    E = energy(simulate(chain(steps * 0.01), Moreau(0.01, theta=0.5), keep=1000))
    # rounding enters each step with some units of 1e-16 and adds up like a random walk, or like
    # steps * 1e-16 where it is biased
    assert np.max(np.abs(E / E[0] - 1.0)) < steps * 1e-16


@pytest.mark.parametrize("theta", [0.6, 0.75, 1.0])
def test_more_than_one_half_loses_energy_in_every_step(theta):
    E = energy(simulate(chain(20.0), Moreau(0.01, theta=theta)))
    assert np.all(np.diff(E) < 0.0)


@pytest.mark.parametrize("theta", [0.0, 0.25, 0.4])
def test_less_than_one_half_gains_energy_in_every_step(theta):
    E = energy(simulate(chain(1.0), Moreau(0.01, theta=theta)))
    assert np.all(np.diff(E) > 0.0)


def test_elastic_impacts_keep_the_energy_with_one_half():
    contacts = LinearContacts(G=[[1.0, 0.0, 0.0]], offset=0.1, restitution=1.0)
    scene = Scene(
        system=LinearSystem(M=np.eye(3)), q0=[1.0, 0.0, 0.0], v0=[-1.0, 0.5, 0.0], t_span=(0.0, 3.0),
        contacts=contacts,
    )  # fmt: skip
    m = simulate(scene, Moreau(0.01))
    assert len(m.impacts) == 1
    np.testing.assert_allclose(np.sum(m.v**2, axis=1), 1.25, rtol=4e-16 * len(m.t))


@pytest.mark.parametrize("r", [0.0, 0.5, 1.0])
def test_impacts_never_create_kinetic_energy(r):
    contacts = LinearContacts(G=np.eye(3), offset=0.2, restitution=r)
    scene = Scene(
        system=LinearSystem(M=M),
        q0=[0.3, 0.2, 0.5],
        v0=[-1.0, -0.5, -1.0],
        t_span=(0.0, 3.0),
        contacts=contacts,
    )
    m = simulate(scene, Moreau(0.01))
    T = 0.5 * np.einsum("ti,ij,tj->t", m.v, M, m.v)
    assert len(m.impacts) >= 3
    assert np.all(np.diff(T) <= 1e-15 * T[0])


def struck(seed):
    """Random M, K and fixed walls with one restitution."""
    rng = np.random.default_rng([11, seed])
    n, n_c = int(rng.integers(2, 5)), int(rng.integers(1, 4))
    B, D, G = rng.normal(size=(n, n)), rng.normal(size=(n, n)), rng.normal(size=(n_c, n))
    system = LinearSystem(M=B @ B.T + 0.3 * n * np.eye(n), K=10.0 ** rng.uniform(0.0, 2.0) * D @ D.T)
    contacts = LinearContacts(G, offset=rng.uniform(0.0, 0.3, n_c), restitution=rng.uniform())
    scene = Scene(system, np.zeros(n), rng.normal(size=n), (0.0, 5.0), contacts)
    return scene, 5.0 / round(5.0 / 10.0 ** rng.uniform(-2.5, -1.3))


def test_contacts_gain_no_more_energy_in_a_step_than_the_bound_says():
    """(1 - r) / (8 (1 + r)) d^T W^-1 d, d: what the forces change the gap velocities by; the bound is reached."""
    closest = 0.0
    for seed in range(60):
        scene, h = struck(seed)
        m = simulate(scene, Moreau(h))
        M, K, G, r = scene.system.M, scene.system.K, scene.contacts.G, scene.contacts.restitution[0]
        E = 0.5 * np.einsum("ti,ij,tj->t", m.v, M, m.v) + 0.5 * np.einsum("ti,ij,tj->t", m.q, K, m.q)
        A = M + 0.25 * h**2 * K
        for k in np.flatnonzero(np.diff(E) > 1e-12 * E[0]):
            a = m.impulse[k + 1] > 0.0
            d = G[a] @ np.linalg.solve(A, -h * K @ (m.q[k] + 0.5 * h * m.v[k]))
            W = G[a] @ np.linalg.solve(A, G[a].T)
            bound = (1.0 - r) / (1.0 + r) / 8.0 * d @ np.linalg.pinv(W) @ d
            closest = max(closest, (E[k + 1] - E[k]) / bound)
    assert 0.5 < closest <= 1.0 + 1e-6
