"""A rod that slides on both of its ends stops with both, whatever a step has left of their velocities."""

import math

import numpy as np
import pytest

from lagrangian import Contacts, Coulomb, Joints, Scene, System
from lcpstep import EventDriven, Kind, Located, Status, simulate

LENGTH, DRAG, G0 = 0.5, 0.21, 9.81


def ground(x, p):
    """Height of the ground p[0] sin(p[1] x + p[2]), its slope and its curvature."""
    phase = p[1] * x + p[2]
    return p[0] * math.sin(phase), p[0] * p[1] * math.cos(phase), -p[0] * p[1] * p[1] * math.sin(phase)


def gap(t, q, v, p, out):
    for c in range(2):
        out[c] = q[2 * c + 1] - ground(q[2 * c], p)[0] - p[3] * math.sin(p[4] * t)


def normal(t, q, v, p, out):
    out[:, :] = 0.0
    for c in range(2):
        out[c, 2 * c], out[c, 2 * c + 1] = -ground(q[2 * c], p)[1], 1.0


def gap_rate(t, q, v, p, out):
    out[:] = -p[3] * p[4] * math.cos(p[4] * t)


def bias(t, q, v, p, out):
    for c in range(2):
        out[c] = -ground(q[2 * c], p)[2] * v[2 * c] ** 2 + p[3] * p[4] ** 2 * math.sin(p[4] * t)


def tangent(t, q, v, p, out):
    out[:, :] = 0.0
    for c in range(2):
        out[c, 2 * c], out[c, 2 * c + 1] = 1.0, ground(q[2 * c], p)[1]


def slip(t, q, v, p, out):
    for c in range(2):
        out[c] = -ground(q[2 * c], p)[1] * p[3] * p[4] * math.cos(p[4] * t)


def force(t, q, v, p, out):
    for i in range(4):
        out[i] = -DRAG * v[i] - G0 * (i % 2)


def rod(t, q, v, p, out):
    out[0] = 0.5 * ((q[2] - q[0]) ** 2 + (q[3] - q[1]) ** 2 - LENGTH**2)


def along(t, q, v, p, out):
    out[0, 0], out[0, 1] = q[0] - q[2], q[1] - q[3]
    out[0, 2], out[0, 3] = q[2] - q[0], q[3] - q[1]


def thrown(x, mu, speed, *p):
    """A rod on the shaking ground, that slides with a speed at its first end, which lies at x."""
    low, high = x, x + LENGTH
    while high - low > 1e-15:
        middle = 0.5 * (low + high)
        far = math.hypot(middle - x, ground(middle, p)[0] - ground(x, p)[0]) > LENGTH
        low, high = (low, middle) if far else (middle, high)
    y, slope, _ = ground(x, p)
    y_end, slope_end, _ = ground(low, p)
    d, rise, up = low - x, y_end - y, p[3] * p[4]
    speed_end = speed * (d + rise * slope) / (d + rise * slope_end)
    friction = Coulomb(mu, tangent, slip)
    return Scene(
        system=System(4, np.diag([1.8, 1.8, 1.7, 1.7]), force),
        contacts=Contacts(2, gap, normal, gap_rate, bias, friction=friction),
        joints=Joints(1, rod, along),
        q0=[x, y, low, y_end], v0=[speed, slope * speed + up, speed_end, slope_end * speed_end + up],
        t_span=(0.0, 1.2), p=p,
    )  # fmt: skip


RODS = [
    ((-0.7, (0.059, 0.69), 0.99, 0.013, 1.4, 1.2, 0.0068, 11.0), 0.001),
    ((0.34, (0.16, 0.052), 0.39, 0.024, 2.7, 5.6, 0.0087, 19.0), 0.001),
    ((0.84, (0.52, 0.47), -0.99, 0.049, 2.3, 3.0, 0.0095, 8.5), 0.003),
    ((-0.75, (0.36, 0.55), 0.91, 0.0089, 2.4, 5.5, 0.0024, 13.0), 0.007),
]


@pytest.mark.parametrize(("rod", "h"), [pytest.param(*RODS[0], marks=pytest.mark.slow), *RODS[1:]])
def test_both_ends_stop_at_one_instant(rod, h):
    scene = thrown(*rod)
    m, exact = simulate(scene, Located(h, max_events=1000)), simulate(scene, EventDriven())
    assert (m.status, exact.status) == (Status.DONE, Status.DONE)
    for run in (m, exact):
        stops = run.impacts[run.impacts.kind != Kind.STICK]
        assert stops.kind.tolist() == [Kind.STICK_TANGENT] * 2
        assert stops.time[0] == stops.time[1]
    np.testing.assert_allclose(m.q[-1], exact.q[-1], atol=2.0 * h * h)
    assert np.max(np.abs(m.v[-1, ::2])) < 1e-12
