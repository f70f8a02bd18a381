"""Bodies that lie on each other, in the steps with located impacts: they come to rest, stay, and keep all digits."""

import numpy as np
import pytest

from lagrangian import Harmonic, LinearContacts, LinearSystem, Scene, scenes
from lcpstep import Located, Moreau, simulate
from tests.stepping.test_several_contacts import line


@pytest.mark.parametrize(("n", "r", "h"), [(4, 0.9, 1e-2), (20, 0.5, 1e-3), (20, 0.5, 0.3)])
def test_a_falling_column_comes_to_rest(n, r, h):
    scene = line(
        0.05 * np.arange(1, n + 1), np.zeros(n), r, walls=True, force=-9.81, t_end=12.0 if r == 0.9 else 3.0
    )
    m = simulate(scene, Located(h))
    G = scene.contacts.G
    energy = 0.5 * np.sum(m.v**2, axis=1) + 9.81 * np.sum(m.q, axis=1)
    assert np.all(m.v[-1] == 0.0)
    assert np.max(np.abs(m.q[-1])) < 1e-13
    assert np.min(m.q @ G.T) > -1e-14
    assert np.max(np.diff(energy)) < 1e-13 * energy[0]
    weight = 9.81 * np.arange(n, 0, -1)
    np.testing.assert_allclose(m.impulse[-1] / (m.t[-1] - m.t[-2]), weight, rtol=1e-12)
    # every impulse is accounted for: momentum balance
    np.testing.assert_allclose(np.sum(m.impulse, axis=0)[0], 9.81 * n * m.t[-1], rtol=1e-12)


def test_a_pile_at_rest_stays_at_rest():
    n = 12
    m = simulate(
        line(np.zeros(n), np.zeros(n), 0.5, walls=True, force=-9.81, t_end=50.0), Located(1e-3), keep=1000
    )
    assert np.all(m.v == 0.0)
    assert np.all(m.q == 0.0)
    assert len(m.impacts) == 0


# --- curved and moving obstacles


def test_a_stiff_linear_chain_is_stable_at_any_step():
    n = 12
    K = 1e6 * (2 * np.eye(n) - np.eye(n, k=1) - np.eye(n, k=-1))
    K[-1, -1] = 1e6
    scene = Scene(
        system=LinearSystem(M=np.eye(n), K=K), contacts=LinearContacts(G=np.eye(n)[:1], restitution=0.0),
        q0=np.full(n, 0.1), v0=np.full(n, -1.0), t_span=(0.0, 0.2),
    )  # fmt: skip
    free = Scene(system=scene.system, q0=scene.q0, v0=scene.v0, t_span=scene.t_span)
    for s in (scene, free):
        m = simulate(s, Located(1e-2))
        energy = 0.5 * np.sum(m.v**2, axis=1) + 0.5 * np.einsum("ti,ij,tj->t", m.q, K, m.q)
        assert np.max(energy) <= energy[0] * (1 + 1e-9)
    assert simulate(scene, Moreau(1e-2)).status.name == "DONE"


@pytest.mark.parametrize("ratio", [1e-9, 1e3, 1e6, 1e9, 1e12])
def test_forces_between_bodies_of_very_different_mass_keep_all_digits(ratio):
    h = 2.0**-10
    m = simulate(scenes.heavy_on_light(ratio=ratio, t_end=0.25), Located(h))
    weights = 9.81 * np.array([1.0 + ratio, ratio])
    np.testing.assert_allclose(m.impulse[1:] / h, np.tile(weights, (len(m.t) - 1, 1)), rtol=1e-14)
    assert np.all(m.v == 0.0)


def test_a_heavy_body_on_light_ones_that_a_table_lifts_is_carried_with_all_digits():
    # not at rest and not plain: the table rises with constant acceleration, so each contact carries m (g + a)
    masses, lift = np.array([1.0, 1e9, 1.0]), 2.0

    def rising(t, q, v, p, out):
        out[:] = 0.0
        out[0, 0], out[0, 1], out[0, 2] = 0.5 * p[0] * t * t, p[0] * t, p[0]

    G = np.eye(3) - np.eye(3, k=-1)
    scene = Scene(
        system=LinearSystem(M=np.diag(masses), force=Harmonic(constant=-9.81 * masses)),
        contacts=LinearContacts(G=G, restitution=0.0, motion=rising),
        q0=np.zeros(3), v0=np.zeros(3), t_span=(0.0, 0.25), p=[lift],
    )  # fmt: skip
    h = 2.0**-8
    m = simulate(scene, Located(h))
    carried = (9.81 + lift) * np.cumsum(masses[::-1])[::-1]
    np.testing.assert_allclose(m.impulse[1:] / h, np.tile(carried, (len(m.t) - 1, 1)), rtol=1e-13)
    np.testing.assert_allclose(m.v, lift * np.tile(m.t[:, None], 3), rtol=0, atol=1e-13)


@pytest.mark.parametrize("n", [3, 30, 100])
def test_a_block_on_many_feet_lies_exactly_still(n):
    m = simulate(scenes.block_on_feet(n=n, t_end=0.1), Located(2.0**-10))
    assert np.all(m.v == 0.0)
    assert np.all(m.q == 0.0)
    forces = m.impulse[-1] / (m.t[-1] - m.t[-2])
    assert np.min(forces) >= 0.0
    assert np.sum(forces) == pytest.approx(9.81, rel=1e-12)
    assert forces @ np.linspace(-0.5, 0.5, n) == pytest.approx(0.981, rel=1e-12)
