"""A body that falls into a rough groove of an elastic and an inelastic plane comes to rest where they meet."""

import numpy as np
import pytest

from lagrangian import Coulomb, LinearContacts, LinearSystem, Scene
from lcpstep import EventDriven, Status, simulate

WEIGHT, T_END = 9.81, 3.0


def groove(angles, restitution, mu, law, v0):
    """A particle of 1 kg, 0.3 m away from two planes, at these angles to the ground."""
    a = np.array([angles[0], -angles[1]])
    normals, tangents = np.stack([np.sin(a), np.cos(a)], 1), np.stack([np.cos(a), -np.sin(a)], 1)
    return Scene(
        LinearSystem(np.eye(2), force=[0.0, -WEIGHT]), [0.0, 0.0], v0, (0.0, T_END),
        LinearContacts(normals, 0.3, restitution, friction=Coulomb(mu, tangents, law=law)),
    )  # fmt: skip


@pytest.mark.parametrize(
    ("angles", "restitution", "mu", "law", "v0"),
    [
        ((0.8, 0.8), (0.5, 1.0), 0.4, "moreau", (0.4, 1.1)),
        ((0.5, 1.0), (0.0, 1.0), 0.3, "moreau", (-0.3, 0.0)),
        ((0.7, 0.8), (0.0, 1.0), 0.6, "moreau", (0.2, 0.3)),
        ((0.8, 1.0), (0.3, 1.0), 0.2, "stronge", (0.6, -0.1)),
    ],
)
@pytest.mark.parametrize("tolerance", [1e-8, 1e-11])
def test_elastic_hops_that_rounding_hides_have_an_end(angles, restitution, mu, law, v0, tolerance):
    """They had gone on for ever: each fell as deep as a gap is not told from zero, and struck as fast as that."""
    scene = groove(angles, restitution, mu, law, v0)
    m = simulate(scene, EventDriven(tolerance, tolerance, max_events=5000))
    assert m.status is Status.DONE
    c = scene.contacts
    np.testing.assert_allclose(m.q[-1], np.linalg.solve(c.G, -c.offset), rtol=0, atol=1e-12)
    np.testing.assert_allclose(m.v[-1], 0.0, rtol=0, atol=1e-12)
    given = c.G.T @ m.impulse.sum(axis=0) + c.friction.tangent.T @ m.friction_impulse.sum(axis=0)
    np.testing.assert_allclose(given, [-v0[0], WEIGHT * T_END - v0[1]], rtol=0, atol=1e-7)
