"""Friction whose coefficient is zero: another loop runs it, and the motion is that without friction."""

from __future__ import annotations

import numpy as np
import pytest

from lagrangian import Coulomb, Harmonic, LinearContacts, LinearJoints, LinearSystem, Scene
from lcpstep import EventDriven, Kind, Located, Status, simulate

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


@pytest.mark.parametrize("friction", [None, Coulomb(0.0, [[1.0, 0.0]] * 2)], ids=["smooth", "rough"])
@pytest.mark.parametrize("slope", [1e-2, 1e-4, 1e-6])
def test_a_body_in_a_flat_notch_slides_up_one_side_of_it(slope, friction):
    """A pull of 0.3 N + 0.1 N sin(3 t) along; the other side, were it held, would have to pull with 1e5 N."""
    t, m_x, m_y = 1.0, 1.0, 2.0
    force = Harmonic(constant=[0.3, -9.0], sine=[0.1, -0.5], omega=3.0)
    sides = LinearContacts([[slope, 1.0], [-slope, 1.0]], 0.0, 0.0, friction=friction)
    system = LinearSystem(np.diag([m_x, m_y]), force=force)
    run = simulate(Scene(system, [0.0, 0.0], [0.0, 0.0], (0.0, t), sides), EventDriven())
    assert run.status is Status.DONE
    constant, sine = 0.3 - 9.0 * slope, 0.1 - 0.5 * slope
    x = (0.5 * constant * t * t + sine * (t / 3.0 - np.sin(3.0 * t) / 9.0)) / (m_x + m_y * slope**2)
    np.testing.assert_allclose(run.q[-1], [x, slope * x], rtol=1e-10, atol=0)
    assert run.impulse[:, 0].sum() == 0.0
    assert run.impulse[:, 1].sum() > 0.0


@pytest.mark.parametrize("method", [EventDriven(), Located(1e-2)], ids=["event-driven", "located"])
@pytest.mark.parametrize("friction", [None, Coulomb(0.0, [[1.0, 0.0]])], ids=["smooth", "rough"])
def test_what_is_taken_along_has_no_velocity_before(friction, method):
    """From a table that begins to rise with 0.4 m/s: u- = 0 is the velocity of the gap before the jump."""
    scene = Scene(
        LinearSystem(np.eye(2), force=[0.0, -G]), [0.0, 0.0], [0.0, 0.0], (0.0, 0.6),
        LinearContacts([[0.0, 1.0]], restitution=0.5, motion=rising, friction=friction), corners=[0.3],
    )  # fmt: skip
    run = simulate(scene, method)
    (hit,) = run.impacts[run.impacts.kind == Kind.IMPACT]
    assert hit.time == 0.3
    assert (hit.before, hit.after) == (0.0, 0.0)
    assert hit.impulse == pytest.approx(0.4, rel=1e-12)


def rising(t, q, v, p, out):
    late = t - 0.3
    out[:] = 0.0
    if late > 0.0:
        out[0, 0], out[0, 1] = 0.4 * late, 0.4
