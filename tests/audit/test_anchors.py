"""Gaps beside events, short hops, and what forces say of tolerances: certified, and no more than that."""

import math
from dataclasses import replace

import numpy as np
import pytest

from benchmarks.audit.cases import TURN, blind, ground, ground_bias, ground_q, swing
from lagrangian import Contacts, Scene, System, scenes
from lcpstep import EventDriven, Located, simulate
from lcpstep.audit import audit
from lcpstep.audit.anchors import apart
from lcpstep.audit.pieces import Pieces
from lcpstep.audit.windows import Windows


@pytest.mark.parametrize(
    ("scene", "method"),
    [
        (scenes.pendulum_stop(t_end=200.0), EventDriven()),  # its last hops are 1e-12 m high
        (scenes.slider_crank(), EventDriven()),  # hops of 1e-8 s at 0.01 s, two releases, two corners at once
        (scenes.chattering_table(t_end=4.0), Located(1e-3)),  # releases from long rests
    ],
    ids=["pendulum", "crank", "table"],
)
def test_all_flights_are_certified(scene, method):
    answer = audit(simulate(scene, method))
    assert not answer.missed
    assert answer.certified == answer.flights > 10
    assert all("closed contact" in x.why for x in answer.windows)


@pytest.mark.parametrize("tolerance", [1e-12, 1e-9, 1e-6])
def test_forces_tell_no_less_than_the_error_of_event_driven_runs(tolerance):
    """An oscillator as a general system, against its closed form."""
    run = simulate(
        replace(passage(0.05), q0=[0.0, 1.0], v0=[1.0, 0.0]), EventDriven(rtol=tolerance, atol=tolerance)
    )
    p = Pieces(run)
    assert p.sharpen()
    assert not p.sharpen()
    t = np.linspace(0.0, 4.0, 2001)
    k = np.minimum(np.searchsorted(p.t, t, side="right") - 1, len(p.t) - 2)
    error = np.abs(run.at(t)[0][:, 1] - np.cos(TURN * t))
    assert len(run.impacts) == 0
    assert np.all(error <= p.problem.anchors.estimated[k, 1] + 1e-14)


def test_distances_end_at_impacts_of_others():
    touched = np.array([[True, False], [False, False], [False, True], [False, False], [True, False]])
    t = np.array([0.0, 1.0, 2.0, 3.0, 4.0])
    quiet = apart(t, touched, np.zeros(5, dtype=bool))
    np.testing.assert_array_equal(quiet[:, 0], [0.0, 1.0, 2.0, 3.0, 0.0])
    np.testing.assert_array_equal(quiet[:, 1], [np.inf, np.inf, 0.0, 1.0, 2.0])
    loud = apart(t, touched, np.array([True, False, True, False, True]))
    np.testing.assert_array_equal(loud[:, 0], [0.0, 1.0, np.inf, np.inf, 0.0])


def test_errors_are_as_small_as_events_are_near_and_no_larger_than_they_were():
    p = Pieces(simulate(scenes.pendulum_stop(t_end=20.0), EventDriven()))
    k = np.flatnonzero(p.touched[:-1, 0] & ~p.closed[:, 0])[:5]
    no, size = np.zeros(len(k), dtype=bool), np.ones(len(k))
    for share in (1e-6, 1e-3, 1.0):
        a, b = p.t[k], p.t[k] + share * np.diff(p.t)[k]
        off = p.problem.anchors.errors(Windows(k, 0 * k, a, b, ~no, no, no), size)[:, 0]
        assert np.all(off <= 2e-11)
        assert np.all(off <= 1e-11 * (1.0 + p.motion.fastest(k)[:, 0]) * (b - a) * (1.0 + 1e-9))
        assert np.all(off > 0.0)


def passage(least):
    """A body above a bump, whose gap is this small where it is smallest."""
    return Scene(
        system=System(2, np.eye(2), swing),
        contacts=Contacts(1, ground, ground_q, restitution=0.8, bias=ground_bias),
        q0=[0.0, math.cos(0.5)], v0=[1.0, -TURN * math.sin(0.5)], t_span=(0.0, 4.0),
        p=[0.05 - least, 1e-2, (3.0 * math.pi - 0.5) / TURN, 1.05],  # the swing is lowest above its top
    )  # fmt: skip


@pytest.mark.parametrize("tolerance", [1e-12, 1e-8])
def test_a_passage_within_the_error_is_listed_and_one_well_above_is_not(tolerance):
    method = EventDriven(rtol=tolerance, atol=tolerance)
    with blind():
        near, far = (audit(simulate(passage(x * tolerance), method)) for x in (3.0, 1e4))
    assert near.windows or near.missed
    assert not far.windows
    assert not far.missed


def test_without_forces_the_last_hops_of_the_pendulum_are_listed(monkeypatch):
    monkeypatch.setattr(Pieces, "sharpen", lambda self: False)
    answer = audit(simulate(scenes.pendulum_stop(t_end=200.0), EventDriven()))
    assert answer.certified < answer.flights


def test_a_crank_by_looser_tolerances_is_certified_as_well():
    answer = audit(simulate(scenes.slider_crank(), replace(EventDriven(), rtol=1e-10, atol=1e-10)))
    assert not answer.missed
    assert answer.certified == answer.flights
