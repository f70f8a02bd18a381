"""Bodies wedged between rough walls, on joints too: forces that hold them press, and lie within the friction cones.

They are not known one by one, but what is told of them must be one of the ways in which the walls may hold the body.
"""

import numpy as np
import pytest

from lagrangian import Coulomb, LinearContacts, LinearJoints, LinearSystem, Scene
from lcpstep import EventDriven, Located, Status, simulate
from tests.marks import seeds


def drawn(seed, n_j, n):
    """Two to four walls around a body at rest, and a load that forces of these within their cones have made up."""
    rng = np.random.default_rng(seed)
    k = int(rng.integers(2, 5))
    J, G, T = rng.normal(size=(n_j, n)), rng.normal(size=(k, n)), rng.normal(size=(k, n))
    pressed, share = rng.random(k), rng.uniform(-0.6, 0.6, k)
    mu = rng.uniform(0.1, 0.8, k)
    load = -pressed @ G - (share * mu * pressed) @ T
    return Scene(
        LinearSystem(M=np.diag(10.0 ** rng.uniform(-0.5, 0.5, n)), force=load),
        q0=np.zeros(n),
        v0=np.zeros(n),
        t_span=(0.0, 0.2),
        contacts=LinearContacts(G, offset=0.0, friction=Coulomb(mu, T)),
        joints=LinearJoints(J) if n_j else None,
    )


@pytest.mark.parametrize("numbers", seeds(150, 50))
@pytest.mark.parametrize(("n_j", "n"), [(0, 2), (1, 3), (2, 4)])
@pytest.mark.parametrize("method", [EventDriven(), Located(1e-2), Located(1e-2, order=4)], ids=repr)
def test_walls_press_and_rub_as_they_can(method, n_j, n, numbers):
    for seed in numbers:
        scene = drawn(seed, n_j, n)
        m = simulate(scene, method)
        assert m.status == Status.DONE, (seed, m.message)
        p, f = m.impulse, m.friction_impulse
        assert np.min(p) >= -1e-12, seed
        assert np.all(np.abs(f) <= scene.contacts.friction.mu * p * (1.0 + 1e-6) + 1e-12), seed
