"""Bent obstacles that close upon a body: whatever the law of impact, no motion goes on beyond that time."""

from __future__ import annotations

import numpy as np
import pytest

from lagrangian import Contacts, LinearSystem, Scene
from lcpstep import EventDriven, Status, simulate

CLOSES = 0.3


def bowl_gap(t, q, v, p, out):
    """g = 0.3 - t - q^2 / 2: positive somewhere up to t = 0.3."""
    out[0] = 0.3 - t - 0.5 * q[0] * q[0]


def bowl_jacobian(t, q, v, p, out):
    out[0, 0] = -q[0]


def bowl_gap_t(t, q, v, p, out):
    out[0] = -1.0


def bowl_bias(t, q, v, p, out):
    out[0] = -v[0] * v[0]


@pytest.mark.parametrize("tolerance", [1e-12, 1e-6])
@pytest.mark.parametrize("restitution", [0.0, 0.4, 1.0])
@pytest.mark.parametrize(("q0", "v0"), [(0.25, 0.0), (0.6, 0.0), (-0.1, 0.7), (0.3, -2.0)])
def test_a_run_ends_where_a_bowl_has_closed_upon_the_body(q0, v0, restitution, tolerance):
    contacts = Contacts(1, bowl_gap, bowl_jacobian, bowl_gap_t, bowl_bias, restitution=restitution)
    scene = Scene(LinearSystem(M=1.0), q0, v0, (0.0, 2.0), contacts)
    m = simulate(scene, EventDriven(tolerance, tolerance, max_events=50_000))
    assert m.status is not Status.DONE
    assert m.t[-1] == pytest.approx(CLOSES, abs=1e-3 + tolerance)
    assert np.all(CLOSES - m.t - 0.5 * m.q[:, 0] ** 2 >= -10.0 * tolerance)
