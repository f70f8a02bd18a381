"""A light body between a wall and a heavy one that comes near: impacts ever closer in time stop the heavy one.

The light body stays at the wall when it meets it, but a force draws it off, so it stands free when the heavy one
comes; each blow takes a share of the heavy one's speed, and the times between blows fall to nothing like squares.
"""

from __future__ import annotations

import numpy as np
import pytest

from lagrangian import Harmonic, LinearContacts, LinearSystem, Scene
from lcpstep import EventDriven, Located, Status, simulate

METHODS = (EventDriven(), Located(0.05), Located(0.05, 4), Located(0.05, "exact"))


def squeezed(mass, restitution, omega):
    """Heavy body at x < y, light body of 1 kg at y < 0, a wall at y = 0; a force that turns if omega > 0."""
    press, draw = 0.3, 0.05
    still, turning = np.array([press, -draw]), np.array([0.1 * press, 0.0])
    if omega > 0.0:
        force = Harmonic(constant=still, sine=turning, omega=omega)
    else:
        force = Harmonic(constant=still)
    return Scene(
        system=LinearSystem(M=np.diag([mass, 1.0]), force=force),
        contacts=LinearContacts(G=[[-1.0, 1.0], [0.0, -1.0]], restitution=[restitution, 0.0]),
        q0=[-0.5, 0.0], v0=[1.0, 0.0], t_span=(0.0, 2.0),
    )  # fmt: skip


@pytest.mark.parametrize("omega", [0.0, 0.5])
@pytest.mark.parametrize("restitution", [0.3, 0.8, 1.0])
@pytest.mark.parametrize("method", METHODS, ids=repr)
def test_it_comes_to_rest_at_the_wall(method, restitution, omega):
    scene = squeezed(2000.0, restitution, omega)
    m = simulate(scene, method, keep=[0.2, 1.0, 2.0])
    assert m.status is Status.DONE
    assert m.v[0, 0] > 0.9
    np.testing.assert_allclose(m.q[1:], 0.0, atol=1e-8)
    np.testing.assert_allclose(m.v[1:], 0.0, atol=1e-8)
    blows = m.impacts.impulse[(m.impacts.contact == 0) & (m.impacts.time < 1.0)]
    assert np.sum(blows) == pytest.approx(2000.0, rel=1e-3)  # its momentum
