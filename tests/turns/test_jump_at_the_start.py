"""A belt that stops as the run begins: what it did before is nothing to a block that rests on it."""

import math

import numpy as np
import pytest

from lagrangian import Coulomb, LinearContacts, LinearSystem, Scene
from lcpstep import EventDriven, Kind, Located, simulate

MU, G, END = 0.2, 9.81, 1.4


def along(t, q, v, p, out):
    out[0, 0], out[0, 1] = 1.0, 0.0


def belt(t, q, v, p, out):
    """Every 4 s at rest for one, with 1 m/s for the next, and back with 0.6 m/s."""
    phase = t - 4.0 * math.floor(t / 4.0)
    out[0] = 0.0 if phase < 1.0 else -1.0 if phase < 2.0 else 0.6


@pytest.mark.parametrize("period", [math.inf, 4.0])
@pytest.mark.parametrize("start", [0.0, 8.0])
@pytest.mark.parametrize(
    "method", [EventDriven(), Located(1e-2), Located(1e-3, order=4), Located(1e-2, tolerance=1e-6)], ids=str
)
def test_a_block_sticks_to_a_belt_that_stops_at_the_start(method, start, period):
    scene = Scene(
        LinearSystem(M=np.eye(2), force=[0.0, -G]),
        contacts=LinearContacts([[0.0, 1.0]], friction=Coulomb(MU, along, slip=belt, mu_s=0.3)),
        q0=[0.0, 0.0], v0=[0.0, 0.0], t_span=(start, start + END), period=period,
    )  # fmt: skip
    run = simulate(scene, method)
    assert list(run.impacts.kind) == [Kind.STICK, Kind.SLIP]
    assert run.impacts.time[1] - start == pytest.approx(1.0, abs=1e-12)
    times = np.linspace(0.0, END, 50)
    exact = 0.5 * MU * G * np.maximum(times - 1.0, 0.0) ** 2
    assert np.max(np.abs(run.at(start + times)[0][:, 0] - exact)) < 1e-12
