"""Dry friction that a user writes into the force, as sign(v): a run that slides on its jump says so."""

import math

import numpy as np

from lagrangian import Scene, System
from lcpstep import Located, Status, simulate


def spring(t, q, v, p, out):
    out[0] = -q[0] - p[0] * ((1.0 if v[0] > 0.0 else 0.0) - (1.0 if v[0] < 0.0 else 0.0))


# Loses 0.2 of its amplitude every half turn: from 1.05 to -0.05, where friction holds the spring
OSCILLATOR = Scene(System(1, [[1.0]], spring), q0=1.05, v0=0.0, t_span=(0.0, 30.0), p=[0.1])


def test_steps_that_only_cross_a_jump_to_and_fro_end_the_run():
    run = simulate(OSCILLATOR, Located(1e-2, order=4, tolerance=1e-4))
    assert run.status == Status.STEP_TOO_SMALL
    assert "have taken the time on" in run.message
    assert run.counts.steps < 1_000_000
    np.testing.assert_allclose([run.t[-1], run.q[-1, 0]], [5.0 * math.pi, -0.05], rtol=0, atol=1e-4)
