"""Obstacles without friction whose velocity jumps at a time that `corners` do not name, by `Located`: closed forms.

What rests had been put back onto them, and so dragged along; by a tolerance no step was short enough.
"""

import math
from dataclasses import replace

import numpy as np
import pytest

from lagrangian import Contacts, LinearContacts, LinearSystem, Scene
from lcpstep import EventDriven, Located, Status, simulate

G, END = 9.81, 0.8
STEPS = [Located(1e-2), Located(1e-2, 4), Located(1e-2, tolerance=1e-6), Located(1e-2, 4, tolerance=1e-8)]
NAMES = ["order 2", "order 4", "tolerance", "tolerance, order 4"]
every = pytest.mark.parametrize("method", STEPS, ids=NAMES)


def moves(t, q, v, p, out):
    """The table has the velocity p[1] from t = p[0] on."""
    out[0, 0] = p[1] * (t - p[0]) if t > p[0] else 0.0
    out[0, 1] = p[1] if t > p[0] else 0.0
    out[0, 2] = 0.0


def gap(t, q, v, p, out):
    out[0] = q[1] - max(t - p[0], 0.0) * p[1]


def jacobian(t, q, v, p, out):
    out[0, 0], out[0, 1] = 0.0, 1.0


def gap_t(t, q, v, p, out):
    out[0] = -p[1] if t > p[0] else 0.0


FLAT = LinearContacts([[0.0, 1.0]], 0.0, 0.5, motion=moves)
CURVED = Contacts(1, gap, jacobian, gap_t, restitution=0.5)  # as far as the kernels know


def above(table, p):
    """A block of 2 kg that slides along the table."""
    block = LinearSystem(np.diag([1.0, 2.0]), force=[0.0, -2.0 * G])
    return Scene(block, [0.0, 0.0], [0.5, 0.0], (0.0, END), table, p=p)


def ends_at(scene, method, y, v, within=1e-11):
    run = simulate(scene, method)
    assert (run.status, run.doubt) == (Status.DONE, "")
    np.testing.assert_allclose(run.q[-1], [0.5 * END, y], rtol=0, atol=within)
    np.testing.assert_allclose(run.v[-1], [0.5, v], rtol=0, atol=within)


@every
@pytest.mark.parametrize("time", [0.0, 0.5, 0.6123456])  # at the start, where a step ends, and within one
@pytest.mark.parametrize("table", [FLAT, CURVED], ids=["flat", "curved"])
def test_a_table_drops_from_under_a_block(table, time, method):
    rest = END - time
    ends_at(above(table, [time, -4.5]), method, -0.5 * G * rest**2, -G * rest)


@every
@pytest.mark.parametrize("table", [FLAT, CURVED], ids=["flat", "curved"])
def test_or_takes_it_along(table, method):
    run = simulate(above(table, [0.6123456, 0.4]), method, keep="impacts")
    rest = END - 0.6123456
    ends_at(above(table, [0.6123456, 0.4]), method, 0.4 * rest, 0.4)
    assert run.impulse.sum() == pytest.approx(2.0 * (0.4 + G * END), abs=1e-9)


def drops_and_climbs(t, q, v, p, out):
    """The table has the velocity p[3 + k] from t = p[k] on."""
    s = last = u = 0.0
    for k in range(3):
        if t >= p[k]:
            s, last, u = s + u * (p[k] - last), p[k], p[3 + k]
    out[0, 0], out[0, 1], out[0, 2] = s + u * (t - last), u, 0.0


@pytest.mark.parametrize("h", [1e-3, 2e-3])
def test_a_table_that_jumps_under_a_hop_strikes_at_its_own_time(h):
    """A step that saw none coming had struck at its end."""
    times, speeds = [0.15085, 0.6175008, 0.6888457], [-0.154, 0.1, 0.0]
    table = LinearContacts([[1.0]], 0.0, 0.977, motion=drops_and_climbs)
    scene = Scene(LinearSystem(1.0, force=[-G]), [0.0], [0.0], (0.0, END), table, p=[*times, *speeds])
    truth = simulate(replace(scene, corners=times), EventDriven(1e-11, 1e-11))
    run = simulate(scene, Located(h))
    assert run.impacts.time == pytest.approx(
        truth.impacts.time[1:], abs=1e-9
    )  # it notes that it rests at first


def turns(t, q, v, p, out):
    """A smooth step of the velocity by p[1], within some p[2]."""
    x = (t - p[0]) / p[2]
    turned = math.tanh(x) if abs(x) < 300.0 else math.copysign(1.0, x)
    far = math.log(math.cosh(x)) if abs(x) < 300.0 else abs(x) - math.log(2.0)
    out[0, 0] = 0.5 * p[1] * (p[2] * far + t)
    out[0, 1] = 0.5 * p[1] * (1.0 + turned)
    out[0, 2] = 0.5 * p[1] * (1.0 - turned**2) / p[2]


@every
@pytest.mark.parametrize("speed", [0.4, -2.5])
def test_a_velocity_that_turns_within_roundings_of_the_time_jumps(method, speed):
    time = 0.6123456
    table = LinearContacts([[1.0]], 0.0, 0.5, motion=turns)
    start = 0.5 * speed * (time - 1e-13 * math.log(2.0))
    scene = Scene(LinearSystem(1.0, force=[-G]), [start], [0.0], (0.0, END), table, p=[time, speed, 1e-13])
    run, rest = simulate(scene, method), END - time
    assert run.q[-1, 0] - start == pytest.approx(
        speed * rest if speed > 0.0 else -0.5 * G * rest**2, abs=1e-6
    )
