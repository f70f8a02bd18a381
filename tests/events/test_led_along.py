"""What joints lead along a surface that it but touches passes it, beside impacts of others at nearly that time."""

import math

import numpy as np
import pytest

from lagrangian import Joints, LinearContacts, LinearSystem, Scene
from lcpstep import EventDriven, Status, simulate


def links(t, q, v, p, out):  # a hub on a rail, and a bob 1 m from it
    out[0], out[1] = q[1], math.hypot(q[2] - q[0], q[3] - q[1]) - 1.0


def turned(t, q, v, p, out):
    r = math.hypot(q[2] - q[0], q[3] - q[1])
    x, y = (q[2] - q[0]) / r, (q[3] - q[1]) / r
    out[0, 0] = out[0, 2] = out[0, 3] = 0.0
    out[0, 1] = 1.0
    out[1, 0], out[1, 1], out[1, 2], out[1, 3] = -x, -y, x, y


def wheel(floor):
    """The hub strikes a wall again as the bob passes its lowest point, where a floor touches its way."""
    G, offset = np.array([[-1.0, 0.0, 0.0, 0.0], [0.0, 0.0, 0.0, 1.0]]), [1.0, 1.0]
    n_c = 2 if floor else 1
    return Scene(
        LinearSystem(M=np.diag([2.0, 2.0, 1.0, 1.0]), force=np.array([0.0, -19.62, 0.0, -9.81])),
        q0=[1.0, 0.0, 1.0, -1.0],
        v0=[1.0, 0.0, 1.0, 0.0],
        t_span=(0.0, 2.0),
        contacts=LinearContacts(G=G[:n_c], offset=offset[:n_c], restitution=0.5),
        joints=Joints(2, links, turned),
    )


@pytest.mark.parametrize("tolerance", [1e-5, 1e-6, 3e-7, 1e-7, 1e-8, 1e-12])
def test_a_bob_led_along_a_floor_passes_it_as_its_hub_strikes(tolerance):
    """The floor has no part in it: the motion is that without."""
    method = EventDriven(tolerance, tolerance)
    run, free = simulate(wheel(True), method), simulate(wheel(False), method)
    assert run.status == Status.DONE
    assert np.max(np.abs(run.at(free.t)[0] - free.q)) < 300.0 * tolerance
