"""Steps that an event, or a corner, makes next to nothing, on surfaces that the motion has left by rounding."""

import numpy as np
import pytest

from lagrangian import Contacts, Coulomb, LinearSystem, Scene
from lcpstep import EventDriven, Located, simulate


def gap(t, q, v, p, out):
    out[0] = 1.0 - np.sqrt(q[0] ** 2 + q[1] ** 2)


def normal(t, q, v, p, out):
    r = np.sqrt(q[0] ** 2 + q[1] ** 2)
    out[0, 0], out[0, 1] = -q[0] / r, -q[1] / r


def tangent(t, q, v, p, out):
    r = np.sqrt(q[0] ** 2 + q[1] ** 2)
    out[0, 0], out[0, 1] = -q[1] / r, q[0] / r


@pytest.mark.parametrize("h", [1e-3, 4e-3])
@pytest.mark.parametrize("corner", [1e-15, 1e-13, 1e-11])
@pytest.mark.parametrize("off", [1e-13, 1e-12])
def test_what_is_left_of_a_gap_is_no_velocity(off, corner, h):
    """Sliding in a bowl: put back over a step of 1e-15 s, 1e-12 m of the gap were 0.03 m/s, in a heap of discs 70."""
    bowl = Contacts(1, gap, normal, friction=Coulomb(0.2, tangent))
    q0 = (1.0 - off) * np.array([0.6, -0.8])
    scene = Scene(
        LinearSystem(np.eye(2), force=[0.0, -9.81]), q0, [0.0, 0.0], (0.0, 0.1), bowl, corners=[corner]
    )
    run, true = simulate(scene, Located(h)), simulate(scene, EventDriven())
    np.testing.assert_allclose(run.v[-1], true.v[-1], rtol=0, atol=0.4 * h * h)
