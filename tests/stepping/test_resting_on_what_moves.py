"""Steps of `Moreau` by a tolerance: what rests on a table that shakes stays there, and needs no short steps."""

import math

import numpy as np
import pytest

from lagrangian import Contacts, Coulomb, Joints, LinearContacts, LinearSystem, Scene, System
from lcpstep import EventDriven, Kind, Moreau, Status, simulate

SIZE, OMEGA = 0.0163, 10.57  # of the table, whose acceleration 1.82 m/s^2 throws nothing up
LENGTH = 0.5


def table(t, q, v, p, out):
    out[0, 0], out[0, 1] = SIZE * math.sin(OMEGA * t), SIZE * OMEGA * math.cos(OMEGA * t)
    out[0, 2] = -SIZE * OMEGA * OMEGA * math.sin(OMEGA * t)


def gap(t, q, v, p, out):
    for c in range(out.shape[0]):
        out[c] = q[2 * c + 1] - SIZE * math.sin(OMEGA * t)


def normal(t, q, v, p, out):
    out[:, :] = 0.0
    for c in range(out.shape[0]):
        out[c, 2 * c + 1] = 1.0


def tangent(t, q, v, p, out):
    out[:, :] = 0.0
    for c in range(out.shape[0]):
        out[c, 2 * c] = 1.0


def rate(t, q, v, p, out):
    out[:] = -SIZE * OMEGA * math.cos(OMEGA * t)


def curvature(t, q, v, p, out):
    out[:] = SIZE * OMEGA * OMEGA * math.sin(OMEGA * t)


def weight(t, q, v, p, out):
    for i in range(out.shape[0]):
        out[i] = -9.81 * (i % 2)


def rod(t, q, v, p, out):
    out[0] = 0.5 * ((q[2] - q[0]) ** 2 + (q[3] - q[1]) ** 2 - LENGTH**2)


def along(t, q, v, p, out):
    out[0, 0], out[0, 1] = q[0] - q[2], q[1] - q[3]
    out[0, 2], out[0, 3] = q[2] - q[0], q[3] - q[1]


@pytest.mark.parametrize("r", [0.0, 0.6])
@pytest.mark.parametrize("curved", [False, True])
@pytest.mark.parametrize("tolerance", [1e-3, 1e-5])
def test_a_body_on_a_shaking_table_is_closed_once_and_follows_it(tolerance, curved, r):
    if curved:
        contacts = Contacts(1, gap, normal, rate, curvature, restitution=r)
        scene = Scene(System(2, np.eye(2), weight), [0.0, 0.0], [0.0, SIZE * OMEGA], (0.0, 2.0), contacts)
    else:
        contacts = LinearContacts(G=1.0, motion=table, restitution=r)
        scene = Scene(LinearSystem(M=1.0, force=-9.81), 0.0, SIZE * OMEGA, (0.0, 2.0), contacts)
    m = simulate(scene, Moreau(1e-2, tolerance=tolerance))
    assert m.status is Status.DONE
    assert len(m.impacts) == 2  # it was given as touching: the first step finds it so
    assert m.counts.steps < 40 / math.sqrt(tolerance)  # a method of order one that changes nothing else
    np.testing.assert_allclose(m.q[:, -1], SIZE * np.sin(OMEGA * m.t), rtol=0, atol=tolerance)


@pytest.mark.parametrize("r", [0.0, 0.6])
def test_a_rod_whose_ends_stick_to_it_shares_its_friction_as_it_likes(r):
    """Friction of the ends and the force of the rod balance whatever they are: steps need not agree on them."""
    friction = Coulomb(0.8, tangent)
    contacts = Contacts(2, gap, normal, rate, curvature, restitution=r, friction=friction)
    q0, v = [0.0, 0.0, 0.4, 0.3], [0.3, SIZE * OMEGA]
    scene = Scene(System(4, np.eye(4), weight), q0, v + v, (0.0, 0.7), contacts, joints=Joints(1, rod, along))
    m = simulate(scene, Moreau(1e-2, tolerance=1e-4))
    assert m.status is Status.DONE
    assert m.counts.steps < 1000
    assert np.sum((m.impacts.kind == Kind.IMPACT) & (m.impacts.contact == 0)) <= 3
    np.testing.assert_allclose(m.q[-1], simulate(scene, EventDriven()).q[-1], rtol=0, atol=1e-4)


def hills(t, q, v, p, out):
    for c in range(out.shape[0]):
        out[c] = q[2 * c + 1] - 0.026 * math.sin(3.25 * q[2 * c] + 2.0)


def hills_normal(t, q, v, p, out):
    out[:, :] = 0.0
    for c in range(out.shape[0]):
        out[c, 2 * c], out[c, 2 * c + 1] = -0.0845 * math.cos(3.25 * q[2 * c] + 2.0), 1.0


def hills_curvature(t, q, v, p, out):
    for c in range(out.shape[0]):
        out[c] = 0.274625 * math.sin(3.25 * q[2 * c] + 2.0) * v[2 * c] ** 2


def hills_tangent(t, q, v, p, out):
    out[:, :] = 0.0
    for c in range(out.shape[0]):
        out[c, 2 * c], out[c, 2 * c + 1] = 1.0, 0.0845 * math.cos(3.25 * q[2 * c] + 2.0)


def weight_and_wind(t, q, v, p, out):
    for i in range(out.shape[0]):
        out[i] = -9.81 if i % 2 else -1.9


@pytest.mark.parametrize("tolerance", [1e-2, 1e-3, 1e-4])
def test_a_rod_that_slides_over_hills_to_a_stop_needs_few_steps(tolerance):
    """Friction slows it where it slides more slowly than the tolerance resolves, and does not let it go."""
    friction = Coulomb([0.31, 0.62], hills_tangent, law="newton")
    contacts = Contacts(2, hills, hills_normal, bias=hills_curvature, restitution=0.51, friction=friction)
    x, y, angle, spin = 0.84, 0.25, 1.0655, -0.12
    q0 = [x, y, x + LENGTH * math.cos(angle), y + LENGTH * math.sin(angle)]
    v0 = [-0.87, 0.58, -0.87 - spin * LENGTH * math.sin(angle), 0.58 + spin * LENGTH * math.cos(angle)]
    scene = Scene(
        System(4, np.eye(4), weight_and_wind), q0, v0, (0.0, 1.7), contacts, joints=Joints(1, rod, along)
    )
    m, true = simulate(scene, Moreau(1e-2, tolerance=tolerance)), simulate(scene, EventDriven())
    assert (m.status, true.status) == (Status.DONE, Status.DONE)
    assert m.counts.steps < 10_000
    np.testing.assert_allclose(m.q[-1], true.q[-1], rtol=0, atol=2.0 * tolerance)
