"""What forces let go is let go once: steps with friction met it, or stopped it, again at once, and let go anew."""

import math

import numpy as np
import pytest

from lagrangian import Contacts, Coulomb, Harmonic, LinearContacts, LinearSystem, Scene
from lcpstep import Kind, Located, simulate

GRAVITY = 9.81
RADIUS = 1.0 / 12.0  # of gyration, squared
OVER, MU = 0.1, 0.5
METHODS = [Located(h) for h in (4e-4, 1e-4, 2e-5)] + [Located(0.05, tolerance=1e-6), Located(1e-4, order=4)]


@pytest.mark.parametrize("method", METHODS, ids=str)
def test_a_conveyor_throws_its_load_once_a_turn(method):
    """It lifts off where the table's acceleration is that of gravity, lands without rebound, slides: 50 times."""
    omega, angle = 2.0 * math.pi * 25.0, math.radians(30.0)
    shake = 1.2e-3 * omega**2
    assert shake * math.sin(angle) > GRAVITY
    table = Harmonic([0.0, -GRAVITY], sine=[shake * math.cos(angle), shake * math.sin(angle)], omega=omega)
    scene = Scene(
        LinearSystem(np.eye(2), force=table),
        q0=[0.0, 0.0],
        v0=[0.0, 0.0],
        t_span=(0.0, 2.0),
        contacts=LinearContacts([[0.0, 1.0]], friction=Coulomb(0.3, [[1.0, 0.0]])),
    )
    log = simulate(scene, method).impacts
    found = [Kind(kind) for kind in log.kind]
    assert found.count(Kind.RELEASE) == found.count(Kind.IMPACT) == 50
    assert found.count(Kind.STICK) == 51
    lifted = math.asin(GRAVITY / (shake * math.sin(angle))) / omega
    assert log.time[log.kind == Kind.RELEASE][0] == pytest.approx(lifted, abs=1e-5)


def gap(t, q, v, p, out):
    out[0] = q[0] * math.sin(q[2]) + q[1] * math.cos(q[2])


def jacobian(t, q, v, p, out):
    s, c = math.sin(q[2]), math.cos(q[2])
    out[0, 0], out[0, 1], out[0, 2] = s, c, q[0] * c - q[1] * s


def bias(t, q, v, p, out):
    s, c = math.sin(q[2]), math.cos(q[2])
    out[0] = 2.0 * v[2] * (v[0] * c - v[1] * s) - v[2] ** 2 * (q[0] * s + q[1] * c)


def along(t, q, v, p, out):
    out[0, 0], out[0, 1], out[0, 2] = math.cos(q[2]), -math.sin(q[2]), 0.0


@pytest.mark.parametrize("h", [4e-3, 2e-3, 1e-3, 5e-4, 2.5e-4])
@pytest.mark.parametrize("order", [2, 4])
def test_a_rod_that_tips_over_an_edge_slips_once(h, order):
    """Its centre a distance d beyond the edge it slips at tan = mu k^2 / (k^2 + 3 d^2), and is thrown off later."""
    scene = Scene(
        LinearSystem(np.diag([1.0, 1.0, RADIUS]), force=[0.0, -GRAVITY, 0.0]),
        q0=[OVER, 0.0, 0.0],
        v0=np.zeros(3),
        t_span=(0.0, 0.8),
        contacts=Contacts(1, gap, jacobian, bias=bias, friction=Coulomb(MU, along)),
    )
    run = simulate(scene, Located(h, order=order))
    assert list(run.impacts.kind) == [Kind.STICK, Kind.SLIP, Kind.RELEASE]
    slips = run.at(run.impacts.time[run.impacts.kind == Kind.SLIP][0])[0][2]
    assert math.tan(slips) == pytest.approx(MU * RADIUS / (RADIUS + 3.0 * OVER**2), abs=4.0 * h**2)
