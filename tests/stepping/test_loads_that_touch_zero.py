"""A body held by a stop with a force that touches zero for an instant: it is never let go, however elastic."""

import math

import numpy as np
import pytest

from lagrangian import LinearContacts, Scene, System
from lcpstep import EventDriven, Kind, Located, Moreau, simulate

METHODS = [
    Located(0.01), Located(0.01, 4), Located(0.002, 4), Located(0.08, tolerance=1e-4),
    Located(0.08, 4, tolerance=1e-6), EventDriven(), EventDriven(1e-6, 1e-6), Moreau(0.01),
]  # fmt: skip


def pushed(t, q, v, p, out):
    out[0] = 1.0 + math.cos(p[0] * t) - p[1] * q[0] - 0.1 * v[0]


def held(rows, restitution, omega):
    """A body of 2 kg on a spring, pushed towards stops that leave it no place."""
    contacts = LinearContacts(rows, restitution=restitution)
    return Scene(
        System(1, [[2.0]], pushed), 0.0, 0.0, (0.0, 15.0), contacts=contacts,
        parameters={"omega": omega, "stiffness": 4.0},
    )  # fmt: skip


@pytest.mark.parametrize("method", METHODS, ids=str)
@pytest.mark.parametrize("restitution", [0.5, 1.0])
@pytest.mark.parametrize("omega", [1.0, 3.0])
@pytest.mark.parametrize("rows", [[[-1.0]], [[-1.0], [1.0]]], ids=["a stop", "two stops"])
def test_it_stays_there(rows, omega, restitution, method):
    run = simulate(held(rows, restitution, omega), method)
    assert np.max(np.abs(run.q)) < 1e-12
    assert np.sum(run.impacts.kind == Kind.IMPACT) <= len(rows)  # as it begins, by `Moreau`
    # what the stops bear: the integral of the force
    exact = run.t[-1] + math.sin(omega * run.t[-1]) / omega
    np.testing.assert_allclose(-(run.impulse @ np.array(rows)).sum(), exact, rtol=1e-3)
