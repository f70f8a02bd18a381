"""Friction whose coefficient is zero: another loop runs it, and the motion is that without friction."""

from __future__ import annotations

import numpy as np
import pytest

from lagrangian import Coulomb, LinearContacts, LinearJoints, LinearSystem, Scene
from lcpstep import EventDriven, Located, Status, simulate

G = 9.0


def shuttle(t, q, v, p, out):
    """A table with the accelerations p[0] and -p[0] in turn, p[1] / 2 each: at rest at every second corner."""
    turn = np.floor(t / p[1])
    since, half = t - turn * p[1], 0.5 * p[1]
    left = p[1] - since
    out[0, 0] = turn * p[0] * half * half
    if since < half:
        out[0, 0] += 0.5 * p[0] * since * since
        out[0, 1], out[0, 2] = p[0] * since, p[0]
    else:
        out[0, 0] += p[0] * half * half - 0.5 * p[0] * left * left
        out[0, 1], out[0, 2] = p[0] * left, -p[0]


@pytest.mark.parametrize("method", [EventDriven(), Located(1e-2, 4)], ids=["event-driven", "located"])
@pytest.mark.parametrize("friction", [None, Coulomb(0.0, [[1.0, 0.0]])], ids=["smooth", "rough"])
@pytest.mark.parametrize("a", [3.0, -3.0])
def test_a_table_that_starts_from_rest_does_not_strike_what_lies_on_it(a, friction, method):
    """It takes the body along, up or down, from a velocity that is exactly zero on the corner where it starts."""
    scene = Scene(
        LinearSystem(np.diag([1.0, 2.0]), force=[0.0, -2.0 * G]), [0.0, 0.0], [0.0, 0.0], (0.0, 1.0),
        LinearContacts([[0.0, 1.0]], restitution=0.5, motion=shuttle, friction=friction),
        p=[a, 0.25], corners=[0.0, 0.125], period=0.25,
    )  # fmt: skip
    m = simulate(scene, method)
    assert m.status is Status.DONE
    assert np.all(m.impacts.impulse == 0.0)
    np.testing.assert_allclose(m.q[-1], [0.0, 4.0 * a * 0.125**2], rtol=0, atol=1e-13)
    assert m.impulse.sum() == pytest.approx(2.0 * G, rel=1e-13)


def parting(t, q, v, p, out):
    """Two joints on one coordinate, that agree up to t = 0.3; or not even in acceleration, for p[0] > 0."""
    late = max(t - 0.3, 0.0)
    out[:] = 0.0
    out[1] = 0.5 * p[0] * t * t + late**3, p[0] * t + 3.0 * late * late, p[0] + 6.0 * late


@pytest.mark.parametrize("method", [EventDriven(), Located(1e-2, 4)], ids=["event-driven", "located"])
@pytest.mark.parametrize("friction", [None, Coulomb(0.0, [[1.0, 0.0]])], ids=["smooth", "rough"])
@pytest.mark.parametrize(("a", "end"), [(0.0, 0.3), (1.0, 0.0)])
def test_joints_that_contradict_each_other_end_the_run(a, end, friction, method):
    scene = Scene(
        LinearSystem(np.eye(2), force=[0.0, -G]), [0.0, 1.0], [0.0, 0.0], (0.0, 1.0),
        LinearContacts([[0.0, 1.0]], friction=friction), LinearJoints([[1.0, 0.0]] * 2, motion=parting), p=[a],
    )  # fmt: skip
    m = simulate(scene, method)
    assert m.status is Status.JOINTS_FAILED
    assert "joint 1 contradicts" in m.message
    assert m.t[-1] == pytest.approx(end, abs=0.02)
