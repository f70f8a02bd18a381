"""Inelastic collapse by `Located`: bodies that strike each other to rest within no time at all."""

import numpy as np
import pytest

from lagrangian import LinearContacts, LinearSystem, Scene
from lcpstep import EventDriven, Kind, Located, simulate

PUSH, PULL, T = 1.0, 2.0, 1.0


def three_in_a_row(r=0.05, t0=0.0):
    """Bodies that touch; the first one strikes and pushes on, the last one leaves and is pulled away."""
    return Scene(
        LinearSystem(M=np.eye(3), force=np.array([PUSH, 0.0, PULL])), [0.0, 0.0, 0.0], [1.0, 0.0, 0.001],
        (t0, t0 + T), contacts=LinearContacts(G=[[-1.0, 1.0, 0.0], [0.0, -1.0, 1.0]], restitution=r),
    )  # fmt: skip


@pytest.mark.parametrize("t0", [0.0, -4096.0])
@pytest.mark.parametrize("order", [2, 4, "exact"])
@pytest.mark.parametrize("h", [0.5, 0.01])
def test_who_collapses_with_others_comes_to_rest_with_them(h, order, t0):
    """The impacts leave all with a third of the momentum; the last one keeps nothing of its last rebound."""
    m = simulate(three_in_a_row(t0=t0), Located(h, order))
    v = 1.001 / 3.0 + np.array([0.5 * PUSH, 0.5 * PUSH, PULL]) * T
    np.testing.assert_allclose(m.v[-1], v, rtol=0, atol=1e-12)
    assert np.count_nonzero(m.impacts.kind == Kind.ACCUMULATION) == 2


def test_so_the_event_driven_run_says():
    m, truth = (simulate(three_in_a_row(), method) for method in (Located(0.01), EventDriven()))
    np.testing.assert_allclose(m.v[-1], truth.v[-1], rtol=0, atol=1e-11)


def test_bodies_that_do_not_collapse_keep_their_rebounds():
    """Impacts of three bodies have an end where these are elastic enough: 7 - 4 sqrt(3) = 0.0718."""
    m = simulate(three_in_a_row(r=0.5), Located(0.01))
    assert m.impacts.time[2] == 0.0
    truth = simulate(three_in_a_row(r=0.5), EventDriven())
    np.testing.assert_allclose(m.v[-1], truth.v[-1], rtol=0, atol=1e-9)
