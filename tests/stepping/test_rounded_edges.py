"""A mass slides over the rounded edge of a table, so fast that it leaves it there: the curvature jumps at a place.

It is asked for through differences of the gap's rate, which see the jump from afar, or at their very middle.
"""

import math

import numpy as np
import pytest

from lagrangian import Contacts, Coulomb, LinearSystem, Scene
from lcpstep import EventDriven, Kind, Located, simulate

MU, G0, RADIUS = 0.1, 9.81, 0.02


def gap(t, q, v, p, out):
    out[0] = (q[1] if q[0] <= 0.0 else math.sqrt(q[0] ** 2 + q[1] ** 2)) - 0.02


def jacobian(t, q, v, p, out):
    r = math.sqrt(q[0] ** 2 + q[1] ** 2)
    out[0, 0], out[0, 1] = (0.0, 1.0) if q[0] <= 0.0 else (q[0] / r, q[1] / r)


def tangent(t, q, v, p, out):
    r = math.sqrt(q[0] ** 2 + q[1] ** 2)
    out[0, 0], out[0, 1] = (1.0, 0.0) if q[0] <= 0.0 else (q[1] / r, -q[0] / r)


@pytest.mark.parametrize(
    "method",
    [EventDriven(), *(Located(1e-3, order=k) for k in (2, 4)),
     *(Located(0.05, order=k, tolerance=tol) for k in (2, 4) for tol in (1e-6, 1e-8, 1e-10))],
    ids=repr,
)  # fmt: skip
@pytest.mark.parametrize("speed", [0.7, 1.0, 2.3])
def test_it_leaves_at_the_edge(speed, method):
    way = -0.1
    scene = Scene(
        LinearSystem(np.eye(2), force=[0.0, -G0]), [way, RADIUS], [speed, 0.0], (0.0, 0.3),
        Contacts(1, gap, jacobian, friction=Coulomb(MU, tangent)),
    )  # fmt: skip
    v = math.sqrt(speed**2 + 2.0 * MU * G0 * way)
    assert v * v > G0 * RADIUS
    leaves = (speed - v) / (MU * G0)
    run = simulate(scene, method)
    assert run.impacts.time[run.impacts.kind == Kind.RELEASE] == pytest.approx([leaves], abs=1e-10)
    later = 0.3 - leaves
    np.testing.assert_allclose(run.q[-1], [v * later, RADIUS - 0.5 * G0 * later**2], rtol=0, atol=1e-10)
    assert len(run.t) < 400
