"""Audits: what a run has missed is reported and taken, and what is certified holds no event."""

import math
from dataclasses import replace

import numpy as np
import pytest

from benchmarks.audit.cases import KINDS, bell, blind, ground, ground_bias, ground_q, swing
from lagrangian import Contacts, LinearSystem, Scene, System, scenes
from lcpstep import EventDriven, Located, simulate
from lcpstep.audit import audit
from lcpstep.errors import LcpStepError
from tests.marks import slow
from tests.turns.test_burrs import oscillator

NOT_LONG = [
    name for name, entry in scenes.CATALOGUE.items()
    if isinstance(entry.make(), Scene) and entry.make().contacts.friction is None
]  # fmt: skip


@pytest.mark.parametrize("name", NOT_LONG)
def test_every_flight_of_the_catalogue_is_certified(name):
    answer = audit(simulate(scenes.CATALOGUE[name].make(), EventDriven()))
    assert not answer.missed
    assert answer.certified == answer.flights
    assert all("closed contact" in x.why for x in answer.windows)


@pytest.mark.parametrize("method", [Located(1e-2), Located(1e-2, order=4), Located(1e-2, order="exact")])
def test_steps_with_located_impacts_are_certified(method):
    for scene in (scenes.impact_oscillator(t_end=20.0), scenes.cam_follower(t_end=0.5)):
        answer = audit(simulate(scene, replace(method, h=1e-3)))
        assert not answer.missed
        assert answer.certified == answer.flights > 0


@pytest.mark.parametrize("method", [EventDriven(1e-5, 1e-5), Located(1e-2)], ids=repr)
def test_a_disc_whose_gap_has_no_gradient_in_its_centre_is_passed_without_a_word_of_numpy(method):
    """A line that passes 3.5e-4 m beside a disc of 5e-6 m: windows about it hold the centre as well."""

    def gap(t, q, v, p, out):
        out[0] = math.hypot(q[0] - 0.5, q[1]) - 5e-6

    def jacobian(t, q, v, p, out):
        far = math.hypot(q[0] - 0.5, q[1])
        out[0, 0], out[0, 1] = (q[0] - 0.5) / far, q[1] / far

    scene = Scene(
        LinearSystem(M=np.eye(2)), [0.0, -0.4995], [1.0, 1.0], (0.0, 1.0), Contacts(1, gap, jacobian)
    )
    run = simulate(scene, replace(method, audit=True))
    assert len(run.impacts) == 0
    assert not run.audit.missed


@pytest.mark.parametrize("width", [1e-2, 1e-3, 1e-4])
def test_a_burr_that_was_flown_through_is_reported(width):
    rng = np.random.default_rng(int(1 / width))
    missed = 0
    for _ in range(8):
        scene = oscillator(bell, [0.9, width, rng.uniform(0.3, 9.7)], rng.uniform(0.0, 6.0))
        t = scene.p[2] + width * np.linspace(-3.0, 3.0, 2001)
        phase = math.atan2(-scene.v0[0] / (2.0 * math.pi), scene.q0[0])
        free = np.cos(2.0 * math.pi * t + phase) + 1.05 - 0.9 * np.exp(-(((t - scene.p[2]) / width) ** 2))
        with blind():
            run = simulate(scene, EventDriven())
        answer = audit(run)
        if free.min() < -1e-9 and len(run.impacts) == 0:
            missed += 1
            assert abs(answer.missed[0].time - scene.p[2]) < 3.0 * width
            assert "MISSED: contact 0" in str(answer)
        elif free.min() > 1e-9:
            assert not answer.missed
            assert answer.share == pytest.approx(1.0)
    assert missed > 0


def over_a_bump(height, width, **more):
    """A body that goes along at 1 m/s, swings, and passes a bump of the ground at 4.4703 m."""
    contacts = Contacts(1, more.pop("gap", ground), ground_q, restitution=0.8, **more)
    return Scene(
        system=System(2, np.eye(2), swing), contacts=contacts, q0=[0.0, 1.0], v0=[1.0, 0.0], t_span=(0.0, 6.0),
        p=[height, width, 4.4703, 1.05], name="bump",
    )  # fmt: skip


@pytest.mark.parametrize("method", [EventDriven(), Located(1e-2)])
@pytest.mark.parametrize("width", [1e-4, 1e-5])
def test_an_event_that_was_missed_is_taken(method, width):
    scene = over_a_bump(0.5, width)
    unnoticed = len(simulate(scene, method).impacts) == 0
    assert unnoticed or width > 1e-5
    m = simulate(scene, replace(method, audit=True))
    assert abs(m.impacts.time[0] - 4.4703) < 3.0 * width
    assert m.scene is scene
    assert not m.audit.missed
    assert ("taken, unnoticed before: contact 0 at 4.4" in str(m.audit)) == unnoticed
    few = simulate(scene, replace(method, audit=True), keep="impacts")
    np.testing.assert_allclose(few.impacts.time, m.impacts.time, rtol=0, atol=1e-12)
    assert few.audit.taken == m.audit.taken


@pytest.mark.parametrize("share", [1e-3, 1e-6, 1e-8])
def test_a_passage_that_is_almost_tangent_is_told_on_both_sides(share):
    """The height at which the bump touches the motion, times 1 plus and minus the share."""
    touching = math.cos(2.0 * math.pi * 4.5) + 1.05
    for sign in (-1.0, 1.0):
        scene = over_a_bump(touching * (1.0 + sign * share), 1e-2)
        scene = replace(scene, p=[touching * (1.0 + sign * share), 1e-2, 4.5, 1.05])
        m = simulate(scene, EventDriven(audit=True))
        assert (len(m.impacts) > 0) == (sign > 0.0)
        assert not m.audit.missed
        assert m.audit.certified == m.audit.flights


@pytest.mark.parametrize("kind", sorted(KINDS))
def test_random_cases_miss_nothing_with_the_audit(kind):
    rng = np.random.default_rng(7)
    for _ in range(6):
        case = KINDS[kind](kind, rng)
        if abs(case.least) < 1e-9:
            continue
        m = simulate(case.scene, EventDriven(audit=True))
        assert (len(m.impacts) > 0) == (case.least < 0.0), case.scene.name
        assert not m.audit.missed


def by_table(t, q, v, p, out):
    """The bump, by a function that intervals cannot pass."""
    ground(t, q, v, p, out)
    out[0] += 0.0 * math.gamma(2.0 + t)


def test_what_intervals_cannot_pass_is_sampled_and_said():
    m = simulate(over_a_bump(0.5, 0.02, gap=by_table), EventDriven(audit=True))
    assert abs(m.impacts.time[0] - 4.4703) < 0.06
    assert m.audit.share < 1.0
    window = m.audit.windows[0]
    assert window.sampled
    assert "sampled: by_table (test_audit.py, line" in window.why
    assert window.gap > 0.0


def by_exception(t, q, v, p, out):
    """The bump, which is there where a logarithm has no value."""
    try:
        out[0] = q[1] + 1.05 + 0.0 * math.log((t - p[2]) ** 2 - p[1] ** 2)
    except ValueError:
        out[0] = q[1] + 1.05 - p[0]


@pytest.mark.slow
@pytest.mark.filterwarnings("ignore::lcpstep.model.UncompiledCallback")
def test_what_an_exception_hides_is_not_certified():
    """Intervals have a logarithm wherever a part of the window has one."""
    scene = over_a_bump(0.06, 1e-3, gap=by_exception)
    with blind():
        answer = audit(simulate(scene, EventDriven()))
    assert "by_exception (test_audit.py, line" in answer.windows[0].why
    assert "catches an exception" in answer.windows[0].why


def points(t, q, v, p, out):
    """Heights at every 5 ms, and straight lines between them, with one burr."""
    k = min(int(200.0 * t), 1999)
    x = 200.0 * t - k
    out[0, 0], out[0, 1], out[0, 2] = p[k] + x * (p[k + 1] - p[k]), 200.0 * (p[k + 1] - p[k]), 0.0


@pytest.mark.filterwarnings("ignore::lcpstep.turns.FastTurn")
@pytest.mark.parametrize("method", [EventDriven(), Located(1e-2), Located(1e-2, order=4)])
@pytest.mark.parametrize("height", slow([0.0, 2.5], 2.5))
def test_a_table_of_points_is_sampled_and_said(method, height):
    heights = 0.02 * np.sin(np.linspace(0.0, 20.0, 2001))
    heights[1003] = height
    scene = oscillator(points, heights, 0.3)
    m = simulate(scene, replace(method, audit=True))
    assert (abs(m.impacts.time[0] - 5.015) < 0.006) if height else (len(m.impacts) == 0)
    assert "sampled: points (test_audit.py, line" in str(m.audit)
    assert m.audit.windows[0].sampled
    assert not m.audit.missed


def test_bounds_that_the_user_declares_certify_it():
    scene = over_a_bump(0.0, 1.0, gap=by_table, lipschitz=40.0)
    answer = simulate(scene, EventDriven(audit=True)).audit
    assert answer.certified == answer.flights == 1
    assert answer.windows == ()


@pytest.mark.parametrize("bad", [0.0, -1.0, math.inf, [1.0, 2.0], "much"])
def test_bounds_that_are_none_are_refused(bad):
    with pytest.raises(ValueError, match="lipschitz"):
        over_a_bump(0.1, 1.0, lipschitz=bad)


def test_a_run_says_where_nothing_could_be_shown():
    answer = audit(simulate(scenes.bowl(), EventDriven()))
    assert answer.share < 1.0
    assert "not certified" in str(answer)
    assert answer.windows[0].end == 5.0


def test_without_contacts_there_is_nothing_to_miss():
    scene = replace(scenes.impact_oscillator(), contacts=None, exact=None)
    assert simulate(scene, EventDriven(audit=True)).audit.share == 1.0


def test_a_run_without_an_audit_has_none():
    assert simulate(scenes.bouncing_ball(t_end=0.1), EventDriven()).audit is None


@pytest.mark.parametrize("method", [EventDriven, Located])
def test_what_is_no_truth_value_is_refused(method):
    with pytest.raises(TypeError, match="audit: expected a bool"):
        method(audit=1)


def test_systems_with_modes_are_refused():
    with pytest.raises(LcpStepError, match=r"audit: .* does not treat systems with modes"):
        simulate(scenes.stick_slip_oscillator(), EventDriven(audit=True))


def test_a_passage_whose_error_is_smaller_in_smaller_windows_is_looked_at_in_them():
    """A bump of the ground is met by 5e-7 m; over windows as wide as the bump the error is taken for 1e-6 m."""
    scene = Scene(
        system=System(2, np.eye(2), swing),
        contacts=Contacts(1, ground, ground_q, bias=ground_bias, restitution=0.8),
        q0=[0.0, -0.6022121078734176], v0=[1.0, -5.0160938448324695], t_span=(0.0, 10.0),
        p=[1.6725157499375298, 0.00010838349044696834, 8.790198492766411, 1.05],
    )  # fmt: skip
    assert len(simulate(scene, EventDriven(audit=True)).impacts) > 0
