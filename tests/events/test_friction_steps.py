"""Runge-Kutta steps with friction: what they see between two samples, what they cost, impulses they leave."""

import math
import warnings

import numpy as np
import pytest

from lagrangian import Coulomb, Harmonic, LinearContacts, LinearSystem, Scene, System
from lcpstep import EventDriven, Kind, simulate


def lifted(t, q, v, p, out):
    """A load along the floor, and the weight, which is outweighed for a moment of p[1] about p[0]."""
    out[0], out[1] = p[2], -1.0 + 1.5 * math.exp(-(((t - p[0]) / p[1]) ** 2))


def on_floor(system, along=0.0, mu=0.3, mu_s=None, slip=0.0, t_end=10.0, p=None):
    friction = Coulomb(mu, [[1.0, 0.0]], mu_s=mu_s, slip=slip)
    return Scene(
        system=system, contacts=LinearContacts([[0.0, 1.0]], friction=friction),
        q0=[0.0, 0.0], v0=[along, 0.0], t_span=(0.0, t_end), p=p,
    )  # fmt: skip


@pytest.mark.parametrize("along", [0.0, 5.0], ids=["sticks", "slides"])
@pytest.mark.parametrize("moment", [0.1, 0.02, 0.005])
def test_a_weight_that_is_gone_for_a_moment_within_a_step_is_seen(along, moment):
    for at in np.random.default_rng(0).uniform(3.0, 9.0, 12):
        p = [at, moment, 0.1 if along == 0.0 else 0.0]
        run = simulate(on_floor(System(2, np.eye(2), lifted), along, p=p), EventDriven(1e-9, 1e-9))
        released = run.impacts.time[run.impacts.kind == Kind.RELEASE]
        # exp(-x^2) > 2/3
        assert abs(released[0] - (at - moment * math.sqrt(math.log(1.5)))) < 1e-7


@pytest.mark.parametrize("omega", [0.5, 3.0, 40.0])
@pytest.mark.parametrize("tolerance", [1e-6, 1e-9, 1e-12])
def test_the_impulse_of_friction_that_turns_while_nothing_moves(omega, tolerance):
    load = Harmonic([0.1, -1.0], sine=[0.15, 0.0], omega=omega)
    run = simulate(on_floor(LinearSystem(np.eye(2), force=load)), EventDriven(tolerance, tolerance))
    carried = np.diff(0.1 * run.t - 0.15 / omega * np.cos(omega * run.t))
    assert np.all(run.v == 0.0)
    assert np.max(np.abs(run.friction_impulse[1:, 0] + carried)) < 10.0 * tolerance
    assert abs(np.sum(run.friction_impulse) + np.sum(carried)) < 10.0 * tolerance


def counted():
    calls = []

    def force(t, q, v, p, out):
        calls.append(t)
        out[0], out[1] = -q[0] - 0.1 * q[0] ** 3, -1.0

    return force, calls


@pytest.mark.parametrize(("tolerance", "most"), [(1e-6, 115), (1e-9, 195), (1e-12, 360)])
def test_a_slip_or_a_stop_asks_for_few_forces(tolerance, most):
    force, calls = counted()
    scene = on_floor(System(2, np.eye(2), force), 0.2, mu=0.6, mu_s=1.0, slip=-0.2, t_end=200.0)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # a counter cannot be compiled
        run = simulate(scene, EventDriven(tolerance, tolerance), keep=[200.0])
    assert len(run.impacts) > 40
    assert len(calls) < most * len(run.impacts)


@pytest.mark.parametrize("omega", [0.5, 3.0, 40.0])
@pytest.mark.parametrize("beyond", [1e-3, 1e-5])
def test_a_load_that_passes_the_edge_for_a_moment_within_a_step_slips(omega, beyond):
    load = Harmonic([0.1, -1.0], sine=[0.2 + beyond, 0.0], omega=omega)
    run = simulate(on_floor(LinearSystem(np.eye(2), force=load)), EventDriven(1e-6, 1e-6))
    slip = run.impacts.time[run.impacts.kind == Kind.SLIP][0]
    assert abs(slip - math.asin(0.2 / (0.2 + beyond)) / omega) < 1e-6
