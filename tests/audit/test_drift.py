"""What steps of order two add up: the estimate against closed forms, and certificates that know it."""

import math
from collections import Counter

import numpy as np
import pytest

from benchmarks.audit.__main__ import MISSED, PASSED, judge, reported
from benchmarks.audit.cases import KINDS, Case, bell, blind, bump
from lagrangian import LinearContacts, LinearSystem, Scene, scenes
from lcpstep import Located, simulate
from lcpstep.audit import audit
from lcpstep.audit.drift import drift
from lcpstep.model import model
from tests.marks import slow


def swinging(rate, phase, span):
    """An oscillator far above its wall."""
    return Scene(
        system=LinearSystem(M=1.0, K=rate**2), contacts=LinearContacts(G=1.0, offset=5.0, restitution=0.8),
        q0=math.cos(phase), v0=-rate * math.sin(phase), t_span=(0.0, span),
    )  # fmt: skip


@pytest.mark.parametrize("seed", range(4))
def test_the_estimate_is_no_smaller_than_the_error_and_not_much_larger(seed):
    rng = np.random.default_rng(seed)
    rate, phase, h = rng.uniform(2.0, 12.0), rng.uniform(0.0, 6.0), 10.0 ** rng.uniform(-3.5, -2.5)
    scene = swinging(rate, phase, 20.0)
    run = simulate(scene, Located(h))
    error = np.abs(run.q[1:, 0] - np.cos(rate * run.t[1:] + phase))
    told = drift(run, model(scene), run.dense.jumps, still_open(run), np.zeros(0))[:, 0]
    assert np.all(error <= told + 1e-9)
    assert told[-1] < 10.0 * error.max()


def still_open(run):
    """No contact is closed in any piece."""
    return np.zeros((len(run.t) - 1, run.scene.n_c), dtype=bool)


def test_under_constant_forces_there_is_none():
    scene = scenes.bouncing_ball()
    run = simulate(scene, Located(1e-2))
    assert drift(run, model(scene), run.dense.jumps, still_open(run), np.zeros(0)).max() < 1e-12


@pytest.mark.parametrize("kind", slow(["tangent", "ground, tangent", "burr", "ground"], "tangent", "burr"))
def test_no_passage_is_certified_that_meets(kind):
    rng = np.random.default_rng(16)
    for _ in range(12):
        case = KINDS[kind](kind, rng)
        run = simulate(case.scene, Located(2e-3, audit=True))
        met = len(run.impacts) > 0
        if met != (case.least < 0.0):
            assert any(abs(x.start - case.scene.p[2]) < 4.0 * case.width + 1e-2 for x in run.audit.windows)


def test_a_wall_within_the_error_is_listed():
    scene = Scene(
        system=LinearSystem(M=1.0, K=40.0), contacts=LinearContacts(G=1.0, offset=1.0 + 1e-6, restitution=0.8),
        q0=0.0, v0=math.sqrt(40.0), t_span=(0.0, 5.0),
    )  # fmt: skip
    answer = audit(simulate(scene, Located(1e-2)))
    assert answer.windows
    assert "as small as the error" in answer.windows[0].why
    assert answer.certified < answer.flights


def passage(motion, p, q0, v0):
    """An oscillator of one turn a second above a table that rises once, as `benchmarks.audit` has it."""
    turn, out = 2.0 * math.pi, np.zeros((1, 3))
    size, phase = math.hypot(q0, v0 / turn), math.atan2(-v0 / turn, q0)
    scene = Scene(
        system=LinearSystem(M=1.0, K=turn**2), q0=q0, v0=v0, t_span=(0.0, 10.0), p=np.array(p),
        contacts=LinearContacts(G=1.0, offset=1.05, restitution=0.8, motion=motion),
    )  # fmt: skip

    def gap(t, q):
        motion(t, None, None, p, out)
        return float(q[0]) + 1.05 - float(out[0, 0])

    near = p[2] - p[1], p[2] + p[1]
    return Case("tangent", p[1], scene, gap, lambda t: (size * math.cos(turn * t + phase),), near)


def near_miss():
    """The exact motion reaches 1.1e-4 m below the table; that of order two is 1.4e-4 m too high by then."""
    return passage(bump, [1.3488807, 5.6762387e-3, 7.02053127], 0.41912522, -5.70468262)


def test_what_the_computed_motion_passes_by_is_listed_and_no_miss_of_the_audit():
    found = Counter()
    judge(near_miss(), Located, {"h": 1e-3}, found)
    assert found[PASSED] == found["of these listed"] == 1
    assert found[MISSED] == 0


def test_order_four_takes_it():
    found = Counter()
    assert len(judge(near_miss(), Located, {"h": 1e-3, "order": 4}, found).impacts) > 0
    assert found[PASSED] == found[MISSED] == 0


@pytest.mark.parametrize("order", [2, 4])
def test_the_judge_tells_a_motion_that_has_flown_through(order):
    case = passage(bell, [1.5, 1e-5, 7.0203], 0.41912522, -5.70468262)
    with blind():
        run = simulate(case.scene, Located(1e-3, order=order))
    assert len(run.impacts) == 0
    assert case.least_of(run) < -0.1
    assert reported(case, run, audit(run))
