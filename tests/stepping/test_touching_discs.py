"""Discs that go on together, touching, after a blow: in every direction, as beads on a line do."""

import math

import numpy as np
import pytest

from lagrangian import Contacts, LinearSystem, Scene
from lcpstep import Located, simulate

METHODS = (
    Located(h=0.01),
    Located(h=0.01, order=4),
    Located(h=0.08, tolerance=1e-4),
    Located(h=0.08, order=4, tolerance=1e-6),
)


def gap(t, q, v, p, out):  # discs of diameter 1 in a row, and a wall across the direction p[0:2] at p[2]
    for i in range(2):
        out[i] = math.hypot(q[2 * i + 2] - q[2 * i], q[2 * i + 3] - q[2 * i + 1]) - 1.0
    out[2] = p[2] - p[0] * q[4] - p[1] * q[5]


def jacobian(t, q, v, p, out):
    for i in range(3):
        for j in range(6):
            out[i, j] = 0.0
    for i in range(2):
        r = math.hypot(q[2 * i + 2] - q[2 * i], q[2 * i + 3] - q[2 * i + 1])
        for k in range(2):
            out[i, 2 * i + 2 + k] = (q[2 * i + 2 + k] - q[2 * i + k]) / r
            out[i, 2 * i + k] = -out[i, 2 * i + 2 + k]
    out[2, 4], out[2, 5] = -p[0], -p[1]


def bias(t, q, v, p, out):
    for i in range(2):
        x, y = q[2 * i + 2] - q[2 * i], q[2 * i + 3] - q[2 * i + 1]
        across = x * (v[2 * i + 3] - v[2 * i + 1]) - y * (v[2 * i + 2] - v[2 * i])
        out[i] = across * across / math.hypot(x, y) ** 3
    out[2] = 0.0


def row(direction, restitution):
    """A disc at 2 m/s, 1 m away from two that touch, and a wall 0.5 m behind these."""
    along = np.array(direction)
    return Scene(
        LinearSystem(M=np.eye(6)),
        q0=np.outer([0.0, 2.0, 3.0], along).ravel(),
        v0=np.outer([2.0, 0.0, 0.0], along).ravel(),
        t_span=(0.0, 3.0),
        p=[*along, 3.5],
        contacts=Contacts(3, gap, jacobian, bias=bias, restitution=restitution),
    )


@pytest.mark.parametrize("method", METHODS, ids=str)
@pytest.mark.parametrize("direction", [(1.0, 0.0), (0.6, 0.8), (0.8, -0.6), (math.cos(1.0), math.sin(1.0))])
def test_discs_that_touch_after_a_blow_strike_together_in_every_direction(direction, method):
    """The pair goes on at (2 + 2 r)/3, turns at the wall, and meets the first again: three blows by the law.

    With r = 1/2: pair 1, first 0; pair -1/2 from t = 1; at t = 2 first -1/2, pair -1/4.
    """
    run = simulate(row(direction, 0.5), method)
    moved = (run.q[-1] - run.q[0]).reshape(3, 2)
    assert moved @ direction == pytest.approx([0.5, -0.25, -0.25], abs=1e-9)
    assert moved @ [-direction[1], direction[0]] == pytest.approx(0.0, abs=1e-9)
    assert len(run.impacts) <= 8  # no contact opens and closes over and over
