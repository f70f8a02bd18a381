"""What steps of order four, and with friction, miss: the estimate against closed forms, and certificates."""

import math
from dataclasses import replace

import numpy as np
import pytest

from benchmarks.audit.cases import KINDS
from lagrangian import Coulomb, LinearContacts, LinearSystem, Scene, scenes
from lcpstep import EventDriven, Located, simulate
from lcpstep.audit import audit, pieces
from lcpstep.audit.pieces import Pieces
from tests.audit.test_drift import swinging


def off(run, exact):
    """How far the motion is off at most, and what is told of that, at many times."""
    t = np.linspace(*run.scene.t_span, 4001)
    k = np.minimum(np.searchsorted(run.t, t, side="right") - 1, len(run.t) - 2)
    return np.abs(run.at(t)[0] - exact(t)), Pieces(run).problem.drift[k]


def is_told(run, exact):
    """The estimate is no smaller than the error, at any time, and at the end not much larger."""
    error, told = off(run, exact)
    assert np.all(error <= told + 1e-11)
    assert told[-1].max() < 10.0 * error.max()


@pytest.mark.parametrize("seed", range(4))
@pytest.mark.parametrize("method", [Located(1.0, order=4), Located(1.0, order=4, tolerance=1e-6)])
def test_the_estimate_is_no_smaller_than_the_error_and_not_much_larger(seed, method):
    rng = np.random.default_rng(seed)
    rate, phase, h = rng.uniform(2.0, 12.0), rng.uniform(0.0, 6.0), 10.0 ** rng.uniform(-2.5, -1.5)
    run = simulate(swinging(rate, phase, 20.0), replace(method, h=h))
    is_told(run, lambda t: np.cos(rate * t + phase)[:, None])


@pytest.mark.parametrize("order", [2, 4])
def test_steps_with_friction_are_told_as_well(order):
    scene = Scene(
        system=LinearSystem(M=np.eye(2), K=30.0 * np.eye(2)),
        contacts=LinearContacts([[0.0, 1.0]], 5.0, 0.8, friction=Coulomb(0.5, [[1.0, 0.0]])),
        q0=[0.0, 1.0], v0=[1.0, 0.0], t_span=(0.0, 10.0),
    )  # fmt: skip
    run = simulate(scene, Located(1e-2, order=order))
    rate = math.sqrt(30.0)
    is_told(run, lambda t: np.stack([np.sin(rate * t) / rate, np.cos(rate * t)], axis=1))


def test_a_pendulum_is_told_against_a_run_that_is_exact():
    scene = scenes.pendulum_stop(t_end=1.0)
    run, true = simulate(scene, Located(2e-2, order=4)), simulate(scene, EventDriven())
    first = int(np.searchsorted(run.t, run.impacts.time[0]))
    told = Pieces(run).problem.drift[: first - 1]
    error = np.abs(run.q[1:first] - true.at(run.t[1:first])[0])
    assert np.all(error <= told + 1e-11)
    assert told.max() < 30.0 * error.max()


def beside_a_wall(h, share):
    """The audit of an oscillator whose wall lies a share of its amplitude beyond it, by steps of order four."""
    scene = Scene(
        system=LinearSystem(M=1.0, K=40.0), contacts=LinearContacts(G=1.0, offset=1.0 + share, restitution=0.8),
        q0=0.0, v0=math.sqrt(40.0), t_span=(0.0, 20.0),
    )  # fmt: skip
    run = simulate(scene, Located(h, order=4))
    error = np.max(np.abs(run.q[:, 0] - np.sin(math.sqrt(40.0) * run.t)))
    return audit(run), error


def test_a_passage_within_the_error_of_coarse_steps_is_not_certified():
    answer, error = beside_a_wall(3e-2, 1e-5)
    assert error > 1e-5
    assert answer.certified < answer.flights
    assert "as small as the error" in answer.windows[0].why


def test_the_same_passage_is_certified_by_fine_steps():
    answer, error = beside_a_wall(2e-3, 1e-5)
    assert error < 1e-7
    assert answer.certified == answer.flights


def test_without_the_estimate_it_would_be_certified(monkeypatch):
    monkeypatch.setattr(pieces.Pieces, "added_up", lambda _: None)
    answer, error = beside_a_wall(3e-2, 1e-5)
    assert error > 1e-5
    assert answer.certified == answer.flights


@pytest.mark.parametrize("kind", sorted(KINDS))
def test_no_passage_is_certified_that_meets(kind):
    rng = np.random.default_rng(16)
    for _ in range(8):
        case = KINDS[kind](kind, rng)
        run = simulate(case.scene, Located(2e-2, order=4, audit=True))
        if (len(run.impacts) > 0) != (case.least < 0.0):
            assert run.audit.windows


def test_forces_of_closed_contacts_are_no_errors():
    run = simulate(scenes.cam_follower(rpm=137.0, t_end=0.9), Located(1e-3, order=4))
    p = Pieces(run)
    assert p.closed.any()
    assert p.problem.drift[p.closed[:, 0]].max() < 1e-3
