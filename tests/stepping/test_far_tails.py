"""Belts and tables with a pulse of far tails: rounding is not measured by what vanishes with them."""

import math

import numpy as np
import pytest

from benchmarks.audit.cases import bell
from lagrangian import Coulomb, LinearContacts, LinearSystem, Scene
from lcpstep import EventDriven, Located, simulate


def pulse(t, q, v, p, out):
    """A belt that stands still but for a pulse."""
    s = (t - p[2]) / p[1]
    out[0] = -p[0] * math.exp(-s * s)


def along(t, q, v, p, out):
    out[0, 0], out[0, 1] = 1.0, 0.0


def falling(t, q, u, p, out):
    out[0] = 0.3 + 0.2 * math.exp(-abs(u[0]) / 0.1)


@pytest.mark.parametrize("order", [2, 4])
def test_a_contact_without_load_in_the_tail_of_a_pulse(order):
    """Forces and velocities of 1e-150, and a step that went over the same place without end."""
    scene = Scene(
        system=LinearSystem(M=[[1.0, 0.3], [0.3, 1.0]], force=[1e-150, -1e-150]),
        contacts=LinearContacts([[0.0, 1.0]], 0.0, 0.5, friction=Coulomb(falling, along, pulse)),
        q0=[0.0, 0.0], v0=[-1e-150, 0.0], t_span=(0.0, 0.3027), p=[-2.8766, 0.14964, 3.02677],
    )  # fmt: skip
    run = simulate(scene, Located(0.0228, order=order, max_events=500))
    assert run.status.name == "DONE"
    assert np.max(np.abs(run.q)) < 1e-100


def test_a_table_that_falls_away_is_left_once():
    """Just after the release the gap is zero to rounding: a polynomial that dips there is no second event."""
    width, time = 0.016617138125495184, 0.12175698776619909
    scene = Scene(
        system=LinearSystem(M=np.eye(2), force=[0.0, -9.81]),
        contacts=LinearContacts([[0.0, 1.0]], 0.0, 0.5, motion=bell, friction=Coulomb(0.7576, along, pulse)),
        q0=[0.0, 0.0], v0=[0.0, 0.0], t_span=(0.0, time + 3.0 * width), p=[7.410858196865915, width, time],
    )  # fmt: skip
    run = simulate(scene, Located(0.0040084482426491225, order=4, max_events=500))
    assert run.status.name == "DONE"
    exact = simulate(scene, EventDriven())
    np.testing.assert_allclose(run.q[-1], exact.q[-1], rtol=0, atol=2e-3)
