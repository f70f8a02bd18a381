"""Where time-stepping with theta = 1/2 gains energy at obstacles at rest: by the work of impulses on what opens."""

import numpy as np
import pytest

from lagrangian import LinearContacts, LinearSystem, Scene
from lcpstep import Moreau, energy, simulate
from tests.marks import slow


def undamped(seed, restitution):
    """Up to four coordinates on springs between up to four walls, all of one restitution."""
    random = np.random.default_rng([9, seed])
    n, m = random.integers(1, 5, 2)
    A, B, G, q0 = (random.normal(size=shape) for shape in ((n, n), (n, n), (m, n), n))
    return Scene(
        LinearSystem(M=A @ A.T + 0.3 * np.eye(n), K=10.0 * B @ B.T), 0.3 * q0, random.normal(size=n), (0.0, 3.0),
        LinearContacts(G, random.uniform(0.0, 0.5, m) - 0.3 * G @ q0, restitution=restitution),
    )  # fmt: skip


@pytest.mark.parametrize("restitution", slow([0.0, 0.3, 0.6], longest=[0.0, 0.6]))
def test_an_impulse_works_as_the_law_of_impact_says_and_gains_energy_where_a_contact_opens(restitution):
    gained, struck = [], 0
    for seed in range(25):
        scene = undamped(seed, restitution)
        run = simulate(scene, Moreau(1e-3, theta=0.5))
        M, K, G = scene.system.M, scene.system.K, scene.contacts.G
        E = 0.5 * np.sum(run.v * (run.v @ M) + run.q * (run.q @ K), axis=1)
        before = run.v[:-1] @ G.T
        p, total = run.impulse[1:], before + run.v[1:] @ G.T
        np.testing.assert_allclose(np.diff(E), 0.5 * np.sum(p * total, axis=1), rtol=0, atol=1e-12 * E[0])
        # what separates and is struck nevertheless has been pushed back by another blow of the step
        at_once = ~(np.any((p > 0.0) & (before > 0.0), axis=1) & np.any((p > 0.0) & (before < 0.0), axis=1))
        struck += np.count_nonzero(at_once & np.any(p > 0.0, axis=1))
        law = 0.5 * (1.0 - restitution) * np.sum(p * before, axis=1)
        np.testing.assert_allclose(np.diff(E)[at_once], law[at_once], rtol=0, atol=1e-12 * E[0])
        gaining = np.diff(E) > 1e-9 * E[0]
        gained.append(np.max(np.diff(E)) / E[0])
        assert set(run.t[1:][gaining]) <= set(energy(run).created.time)
    assert struck > 400
    assert 1e-8 < max(gained) < 1e-4
