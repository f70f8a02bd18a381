"""Runs that begin on a corner take the forces of the side on which they go on, by every method."""

import math

import numpy as np
import pytest
from scipy import sparse

from lagrangian import LinearContacts, LinearSystem, Scene, System
from lcpstep import EventDriven, Located, Moreau, simulate

PUSH = 3.0


def pushed(t, q, v, p, out):
    """Force in the first half of every period; on a corner it tells of the half before."""
    phase = t - math.floor(t)
    out[0] = p[0] if 0.0 < phase <= 0.5 else 0.0


def shaken(t, q, v, p, out):
    pushed(t, q, v, p, out[0, 2:])
    phase = t - math.floor(t)
    within = phase if phase < 0.5 else 0.5
    out[0, 1] = p[0] * within
    out[0, 0] = p[0] * (0.5 * within * within + (phase - within) * within)


def scene(system, periods, **given):
    return Scene(
        system=system, q0=given.get("q0", [0.0]), v0=given.get("v0", [0.0]), p=[PUSH], corners=[0.0, 0.5],
        period=1.0, t_span=(float(periods), periods + given.get("span", 0.4)), contacts=given.get("contacts"),
    )  # fmt: skip


METHODS = [
    pytest.param(EventDriven(), id="event-driven"),
    pytest.param(Located(0.04), id="located"),
    pytest.param(Located(0.04, order=4), id="located 4"),
    pytest.param(Moreau(0.04), id="moreau"),
]
SYSTEMS = [
    pytest.param(System(n_q=1, mass=1.0, force=pushed), id="general"),
    pytest.param(LinearSystem(M=1.0, force=pushed), id="linear"),
]


@pytest.mark.parametrize("method", METHODS)
@pytest.mark.parametrize("system", SYSTEMS)
@pytest.mark.parametrize("periods", [0, 1, 10**4])
def test_a_force_that_sets_in_at_the_start_is_there_from_the_start(system, method, periods):
    made = scene(system, periods)
    run = simulate(made, method)
    t = made.t_span[1] - made.t_span[0]
    assert run.v[-1, 0] == pytest.approx(PUSH * t, abs=1e-11)
    assert run.q[-1, 0] == pytest.approx(0.5 * PUSH * t * t, abs=1e-11)


@pytest.mark.parametrize("method", [lambda h: EventDriven(), Located, Moreau])
@pytest.mark.parametrize("span", [0.4, 1e-3])
def test_a_frame_that_sets_out_at_the_start_pushes_from_the_start(method, span):
    run = simulate(scene(LinearSystem(M=1.0, force=0.0, frame=shaken), 0, span=span), method(min(0.04, span)))
    assert run.q[-1, 0] == pytest.approx(-0.5 * PUSH * span**2, abs=1e-14)
    assert run.v[-1, 0] == pytest.approx(-PUSH * span, abs=1e-14)


@pytest.mark.usefixtures("sparse_steps")
def test_sparse_scenes_begin_alike():
    n = 3

    def all_pushed(t, q, v, p, out):
        phase = t - math.floor(t)
        out[:] = p[0] if 0.0 < phase <= 0.5 else 0.0

    M = sparse.identity(n, format="csr")
    made = scene(LinearSystem(M=M, K=0.0 * M, force=all_pushed), 0, q0=np.zeros(n), v0=np.zeros(n))
    run = simulate(made, Moreau(0.04))
    np.testing.assert_allclose(run.v[-1], PUSH * 0.4, rtol=0, atol=1e-12)


@pytest.mark.parametrize("order", [2, 4])
@pytest.mark.parametrize("periods", [0, 10**4])
def test_an_elastic_contact_at_rest_stays_where_the_frame_sets_out_at_the_start(order, periods):
    """The frame presses the body onto the wall, from a moment after the start on which its speed is no longer 0."""
    made = scene(
        LinearSystem(M=1.0, force=0.0, frame=shaken), periods,
        contacts=LinearContacts(G=1.0, restitution=1.0),
    )  # fmt: skip
    run = simulate(made, Located(0.004, order))
    assert len(run.impacts) == 0
    np.testing.assert_allclose(run.q, 0.0, rtol=0, atol=1e-15 * (1 + periods))  # times round by so much
    assert np.sum(run.impulse) == pytest.approx(PUSH * 0.4, abs=1e-11)
