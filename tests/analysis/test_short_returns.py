"""Maps from event to event do not follow the motion to the end of the scene's span for an event that comes early."""

from dataclasses import replace

import numpy as np
import pytest

from lagrangian import Contacts, LinearSystem, Scene, scenes
from lcpstep import EventDriven
from lcpstep.maps import EventMap, SwitchMap, iterate

SHORT, LONG = 20.0, 5000.0  # s


def wall(t, q, v, p, out):
    out[0] = 1.0 - np.sqrt(q[0] ** 2 + q[1] ** 2)


def inwards(t, q, v, p, out):
    out[0, 0] = -q[0] / np.sqrt(q[0] ** 2 + q[1] ** 2)
    out[0, 1] = -q[1] / np.sqrt(q[0] ** 2 + q[1] ** 2)


def round_billiard(t_end):
    """A point within a circle, along chords of one length."""
    return Scene(
        LinearSystem(np.eye(2)),
        [0.3, 0.1],
        [0.8, 0.6],
        (0.0, t_end),
        Contacts(1, wall, inwards, restitution=1.0),
    )


def test_chords_of_a_round_billiard_are_found_without_all_that_follow():
    near, far = (EventMap(round_billiard(t_end), EventDriven(), "IMPACT") for t_end in (SHORT, LONG))
    x = near.entry()
    assert np.max(np.abs(iterate(far, x, 30) - iterate(near, x, 30))) < 1e-12
    back = far.next(x)
    chord = -2.0 * (x[0] * x[2] + x[1] * x[3])  # of unit speed
    assert back.time - back.start == pytest.approx(chord, abs=1e-12)
    assert back.run.t[-1] < 100.0 * chord < 0.05 * LONG
    assert np.max(np.abs(far.jacobian(x) - near.jacobian(x))) < 1e-11


def test_entries_into_a_mode_are_found_without_all_that_follow():
    scene = scenes.bilinear_oscillator()
    far = SwitchMap(replace(scene, t_span=(0.0, LONG), exact=None), EventDriven(), "right")
    near = SwitchMap(replace(scene, t_span=(0.0, SHORT), exact=None), EventDriven(), "right")
    x = near.entry()
    assert np.max(np.abs(far(x) - near(x))) < 1e-11
    assert far.next(x).run.t[-1] < 100.0 * near.duration(x) < 0.2 * LONG
