"""Runs whose steps would go on without end say why they stop, and where; those that are merely long go on."""

import itertools
import math

import numpy as np
import pytest

from lagrangian import Contacts, Coulomb, LinearContacts, LinearSystem, Scene, System
from lcpstep import EventDriven, Located, Moreau, Status, simulate
from lcpstep.doubts.kinks import valley
from lcpstep.doubts.standstill import LEAST, STEPS, Standstill

FALLS = LinearSystem(np.eye(2), force=[0.0, -9.81])


def gap(t, q, v, p, out):
    """Slopes p[0] on the left of the kink and p[1] on its right."""
    out[0] = q[1] - (p[0] if q[0] < 0.0 else p[1]) * q[0]


def normal(t, q, v, p, out):
    out[0, 0], out[0, 1] = -(p[0] if q[0] < 0.0 else p[1]), 1.0


def tangent(t, q, v, p, out):
    out[0, 0], out[0, 1] = 1.0, p[0] if q[0] < 0.0 else p[1]


def at_rest(t, q, v, p, out):
    out[0] = 0.0


def as_one(slopes, q, mu):
    friction = None if mu is None else Coulomb(mu, tangent, slip=at_rest)
    ground = Contacts(1, gap, normal, bias=at_rest, restitution=0.0, friction=friction)
    return Scene(FALLS, q, [0.2, 0.0], (0.0, 6.0), ground, p=slopes)


def as_two(slopes, q, mu):
    friction = None if mu is None else Coulomb(mu, [[1.0, s] for s in slopes], slip=[0.0, 0.0])
    planes = LinearContacts([[-s, 1.0] for s in slopes], restitution=0.0, friction=friction)
    return Scene(FALLS, q, [0.2, 0.0], (0.0, 6.0), planes)


METHODS = [
    (EventDriven(), 1e-9), (Located(1e-2, tolerance=1e-5), 1e-4), (Moreau(1e-2, tolerance=1e-4), 1e-3),
    (Located(1e-2, 4, tolerance=1e-6), 1e-5),
]  # fmt: skip


@pytest.mark.parametrize(
    ("method", "off", "mu"),
    [
        *((*method, None) for method in METHODS),
        *(pytest.param(*method, 0.2, marks=pytest.mark.slow) for method in METHODS[1:-1]),
        *(pytest.param(*method, 0.2, marks=pytest.mark.thorough) for method in (METHODS[0], METHODS[-1])),
    ],
)
def test_a_valley_given_as_one_gap_ends_a_run_where_two_contacts_would_hold_the_body(method, off, mu):
    """Runs took steps of 1e-12 s at its bottom without end; up to there they are right."""
    m = simulate(as_one([-0.5, 0.5], [-0.3, 0.4], mu), method)
    assert m.status == Status.STEP_TOO_SMALL
    assert "contact 0 has a kink" in m.message
    assert "two contacts" in m.message
    assert m.counts.steps < 5 * STEPS
    assert abs(m.q[-1, 0]) < 1e-9
    true = simulate(as_two([-0.5, 0.5], [-0.3, 0.4], mu), EventDriven(), keep=m.t)
    assert m.q == pytest.approx(true.q, abs=off)


@pytest.mark.parametrize("slopes", [(0.5, -0.5), (-0.5, -0.5)])
def test_a_ridge_and_a_plane_are_no_valley(slopes):
    assert valley(as_one(slopes, [0.0, 0.0], None), 0.0, np.zeros(2), np.zeros(2)) == ""


def test_the_bottom_of_a_round_bowl_is_no_kink():
    def bowl(t, q, v, p, out):
        out[0] = q[1] - 1e3 * q[0] * q[0]

    def across(t, q, v, p, out):
        out[0, 0], out[0, 1] = -2e3 * q[0], 1.0

    scene = Scene(FALLS, [0.0, 0.0], [0.0, 0.0], (0.0, 1.0), Contacts(1, bowl, across))
    assert valley(scene, 0.0, np.zeros(2), np.zeros(2)) == ""


@pytest.mark.parametrize(
    "method",
    [
        pytest.param(Located(1e-2, 4, tolerance=1e-6), marks=pytest.mark.thorough),
        Moreau(1e-2, tolerance=1e-6),
    ],
)
def test_a_force_that_counts_its_calls_ends_a_run_that_it_would_make_endless(method):
    calls = itertools.count()

    def grows(t, q, v, p, out):
        out[0] = -9.81 + 1e-3 * next(calls)

    m = simulate(Scene(System(1, 1.0, grows), 1.0, 0.0, (0.0, 3.0), LinearContacts([[1.0]])), method)
    assert m.status in (Status.STEP_TOO_SMALL, Status.NEWTON_FAILED)
    assert "force must be functions of time and state, and are not" in m.message


def at_peace():
    return 1.0


def test_impacts_may_be_as_many_as_they_like():
    """Light balls between heavy ones meet them a million times in a moment."""
    for impacts, stands in ((STEPS // 2, False), (STEPS // 200, True)):
        look = Standstill((0.0, 1.0), math.inf)
        assert not look.reached(0, 0.5, lambda since: 0, at_peace)
        assert look.reached(2 * STEPS, 0.5 + 0.5 * LEAST, lambda since, n=impacts: n, at_peace) is stands


def test_why_a_run_crawls_is_asked_once_in_many_steps():
    """It was asked at every look from then on; portions, a tenth of a second each, came down to one step."""
    look = Standstill((0.0, 1.0), math.inf)
    asked = 0
    for steps in range(0, 10 * STEPS, 100):
        assert not look.reached(steps, 1e-3 * steps / STEPS, lambda since: 0, at_peace)
        asked += look.crawls
    assert asked == 9


def test_steps_of_the_size_asked_for_are_no_standstill():
    look, h = Standstill((0.0, 1.0), 1e-15), 1e-15
    assert not any(look.reached(k, k * h, lambda since: 0, at_peace) for k in range(0, 10 * STEPS, 1000))


@pytest.mark.slow
def test_a_ball_between_walls_that_close_in_ends_a_run_that_would_go_on_ever_faster():
    """Ten million impacts were searched and kept, by `Moreau` 24 million, up to 4e-7 s before the walls meet."""

    def near(t, q, v, p, out):
        out[:] = 0.0
        out[0, :2], out[1, :2] = (0.2 * t, 0.2), (0.3 * t, 0.3)

    walls = LinearContacts([[1.0], [-1.0]], [0.0, 1.0], 1.0, motion=near)
    m = simulate(Scene(LinearSystem([[1.0]]), 0.5, -1.0, (0.0, 3.0), walls), Located(1e-3))
    assert m.status == Status.STEP_TOO_SMALL
    assert "as where bodies go to and fro between obstacles that close in, at t = " in m.message
    n = len(m.impacts)
    assert n < 2.1e6
    assert abs(m.v[-1, 0]) == pytest.approx(1.0 + 0.5 * n, abs=0.5)  # a wall adds twice its own speed


def test_a_light_ball_between_heavy_ones_may_meet_them_a_million_times():
    """About pi sqrt(M / m) times, all near the wall."""
    many = 1_100_000
    angle = np.pi / (many + 0.5)
    masses, G = np.diag([1.0, np.tan(angle) ** -2]), [[1.0, 0.0], [-1.0, 1.0]]
    scene = Scene(
        LinearSystem(masses), [1.0, 2.0], [0.0, -1.0], (0.0, 1e3), LinearContacts(G, restitution=1.0)
    )
    m = simulate(scene, EventDriven())
    assert m.status == Status.DONE
    assert len(m.impacts) == many


def test_many_short_steps_are_no_standstill_though_the_motion_gains_energy():
    """A cam-follower begins at rest; by steps of 1e-7 s its first million ended the run."""
    speed = itertools.count(1)
    for h, span in ((1e-7, 100.0), (math.inf, 1e6)):
        look = Standstill((0.0, span), h)
        times = ((k, k * min(h, 1e-4)) for k in range(0, 20 * STEPS * STEPS // 100, 500_000))
        assert not any(look.reached(k, t, lambda since: 0, lambda: 2.0 ** next(speed)) for k, t in times)
