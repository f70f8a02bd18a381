"""An obstacle far away that nothing ever meets changes no motion: it rounds no gap but its own."""

import math

import numpy as np
import pytest
from scipy import sparse

from lagrangian import LinearContacts, LinearSystem, Scene
from lcpstep import Moreau, simulate

SIZE, OMEGA = 0.01, 5.0
FAR = 26145.0


def table(t, q, v, p, out):
    out[:, :] = 0.0
    out[0, 0], out[0, 1] = SIZE * math.cos(OMEGA * t), -SIZE * OMEGA * math.sin(OMEGA * t)
    out[0, 2] = -SIZE * OMEGA * OMEGA * math.cos(OMEGA * t)


def falls(made, *offsets):
    """A ball that begins at rest on a table which goes down under it; a wall for each offset but the first."""
    walls = LinearContacts(made(np.ones((len(offsets), 1))), list(offsets), 0.8, motion=table)
    return Scene(LinearSystem(made(np.eye(1)), force=[-9.81]), [0.0], [0.0], (0.0, 0.5), walls)


@pytest.mark.usefixtures("sparse_steps")
@pytest.mark.parametrize("made", [np.asarray, sparse.csr_array])
def test_a_wall_that_is_never_met_changes_nothing(made):
    """Gaps of 1e-9 m counted as closed beside it, and the ball was 6e-6 m off from its second step on."""
    alone, beside = (simulate(falls(made, *at), Moreau(1e-3)) for at in ([SIZE], [SIZE, FAR]))
    np.testing.assert_array_equal(beside.q, alone.q)
    np.testing.assert_array_equal(beside.v, alone.v)


@pytest.mark.usefixtures("sparse_steps")
@pytest.mark.parametrize("made", [np.asarray, sparse.csr_array])
def test_it_tells_no_scale_of_what_begins_at_zero(made):
    """A ball dropped from 1e-9 m falls to its floor, whose gap is the only length there is."""
    floor = LinearContacts(made(np.array([[1.0, 0.0], [0.0, 1.0]])), [0.0, FAR], 0.0)
    scene = Scene(
        LinearSystem(made(np.eye(2)), force=[-9.81, 0.0]), [1e-9, 0.0], [0.0, 0.0], (0.0, 1e-4), floor
    )
    run = simulate(scene, Moreau(1e-6, theta=0.5))
    t = np.array([5e-6, 1e-5])
    np.testing.assert_allclose(run.at(t)[0][:, 0], 1e-9 - 0.5 * 9.81 * t**2, rtol=1e-9)
    assert abs(run.q[-1, 0]) < 1e-10
