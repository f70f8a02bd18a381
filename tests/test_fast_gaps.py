"""Gaps that turn fast with the place: a warning says so where samples show it, and nowhere else."""

import math
import warnings
from dataclasses import replace

import numpy as np
import pytest

from benchmarks.judge.describe import Description
from lagrangian import Contacts, Coulomb, Scene, System, scenes
from lcpstep import EventDriven, Kind, Located, simulate
from lcpstep.turns import FastTurn
from tests.audit.test_audit import over_a_bump

CURVED = [
    name for name, entry in scenes.CATALOGUE.items()
    if isinstance(entry.make(), Scene) and isinstance(entry.make().contacts, Contacts)
]  # fmt: skip


def washboard(t, q, v, p, out):
    """Waves of the ground, of wavelength 2 pi p[1]."""
    out[0] = q[1] + p[3] - p[0] * (1.0 + math.cos(q[0] / p[1]))


def washboard_q(t, q, v, p, out):
    """Its Jacobian."""
    out[0, 0], out[0, 1] = p[0] * math.sin(q[0] / p[1]) / p[1], 1.0


def roof(t, q, v, p, out):
    """A ground of straight pieces."""
    out[0] = q[1] + p[3] - p[0] * max(0.0, 1.0 - abs(q[0] - p[2]) / p[1])


def roof_q(t, q, v, p, out):
    """Its Jacobian."""
    x = q[0] - p[2]
    out[0, 0], out[0, 1] = (math.copysign(p[0] / p[1], x) if abs(x) < p[1] else 0.0), 1.0


def groove(t, q, v, p, out):
    """Walls at the angles p[0] and p[1] from the vertical's foot, in which a cylinder lies; q = (x, y, angle)."""
    out[0] = math.sin(p[0]) * q[0] + math.cos(p[0]) * q[1]
    out[1] = -math.sin(p[1]) * q[0] + math.cos(p[1]) * q[1]


def groove_q(t, q, v, p, out):
    """Its Jacobian."""
    out[0, 0], out[0, 1], out[0, 2] = math.sin(p[0]), math.cos(p[0]), 0.0
    out[1, 0], out[1, 1], out[1, 2] = -math.sin(p[1]), math.cos(p[1]), 0.0


def along_groove(t, q, v, p, out):
    """Sliding velocities of the cylinder, radius p[2], on the walls."""
    out[0, 0], out[0, 1], out[0, 2] = math.cos(p[0]), -math.sin(p[0]), p[2]
    out[1, 0], out[1, 1], out[1, 2] = math.cos(p[1]), math.sin(p[1]), p[2]


def flat(t, q, v, p, out):
    """Walls are."""
    out[0] = out[1] = 0.0


def weight(t, q, v, p, out):
    """Of 1 kg."""
    out[0], out[1], out[2] = 0.0, -9.81, 0.0


def over(gap, jacobian, p, method):
    """What is warned of a run."""
    scene = over_a_bump(0.1, 1.0)
    contacts = replace(scene.contacts, gap=gap, jacobian=jacobian)
    with warnings.catch_warnings(record=True) as said:
        warnings.simplefilter("always")
        simulate(replace(scene, contacts=contacts, p=p), method)
    return [str(x.message) for x in said if x.category is FastTurn]


@pytest.mark.parametrize("wave", [1e-3, 1e-4])
def test_a_washboard_finer_than_the_steps_is_told(wave):
    said = over(washboard, washboard_q, [0.02, wave, 0.0, 1.05], EventDriven())
    assert len(said) == 1
    assert "the gap of contact 0 turns within less than" in said[0]
    assert "audit=True" in said[0]
    assert "corners" in said[0]
    assert not over(washboard, washboard_q, [0.02, wave, 0.0, 1.05], EventDriven(audit=True))


@pytest.mark.parametrize("wave", [0.1, 1.0])
@pytest.mark.parametrize("method", [EventDriven(), Located(1e-2), Located(1e-2, order=4)])
def test_one_that_steps_resolve_is_not(wave, method):
    assert not over(washboard, washboard_q, [0.02, wave, 0.0, 1.05], method)


def test_a_narrow_bump_that_a_sample_meets_is_told():
    """Bumps much narrower than a step, at 20 places."""
    told = 0
    for k in range(20):
        scene = replace(over_a_bump(0.3, 2e-3), p=[0.3, 2e-3, 2.0 + 0.1973 * k, 1.05])
        with warnings.catch_warnings(record=True) as said:
            warnings.simplefilter("always")
            simulate(scene, EventDriven())
        told += any(x.category is FastTurn for x in said)
    assert told > 0


@pytest.mark.parametrize("width", [0.1, 0.5, 2.0])
def test_corners_of_the_ground_are_not_told(width):
    for k in range(5):
        assert not over(roof, roof_q, [0.4, width, 3.0 + 0.31 * k, 1.05], EventDriven())


@pytest.mark.parametrize("name", CURVED)
def test_no_ready_scene_is_warned_of(name):
    with warnings.catch_warnings():
        warnings.simplefilter("error", FastTurn)
        simulate(scenes.CATALOGUE[name].make(), EventDriven())


@pytest.mark.parametrize(
    ("angle", "method"),
    [
        (0.1, Located(0.1, order=4, tolerance=1e-4)),
        (0.2, Located(2.5e-3, order=4)),
    ],
)
def test_what_lies_still_in_a_groove_at_zero_tells_nothing(angle, method):
    """A spinning cylinder comes to rest where all coordinates of the gaps are zero but for rounding of 1e-50 m."""
    a, mu, R = math.pi / 4.0, 0.3, 0.1
    contacts = Contacts(2, groove, groove_q, bias=flat, friction=Coulomb(mu, along_groove))
    body = System(3, np.diag([1.0, 1.0, 0.5 * R * R]), weight)
    scene = Scene(body, [0.0] * 3, [0.0, 0.0, 40.0], (0.0, 3.0), contacts, p=[a, angle, R])
    with warnings.catch_warnings():
        warnings.simplefilter("error", FastTurn)
        run = simulate(scene, method)
    # Forces of both walls, each with its friction, carry the weight; their frictions stop the spin
    n = np.array([[math.sin(a), math.cos(a)], [-math.sin(angle), math.cos(angle)]])
    t = np.array([[math.cos(a), -math.sin(a)], [math.cos(angle), math.sin(angle)]])
    N = np.linalg.solve((n - mu * t).T, [0.0, 9.81])
    stops = run.impacts.time[run.impacts.kind == Kind.STICK_TANGENT]
    np.testing.assert_allclose(stops, 40.0 * 0.5 * R / (mu * N.sum()), rtol=1e-12)


def test_steps_as_short_as_rounding_of_time_lets_an_obstacle_move_tell_nothing():
    shaken = Description(
        M=((2660.0, 0.0, 0.0), (0.0, 15.7, 0.0), (0.0, 0.0, 0.00918)), q0=(0.072, 0.873, 1.49), v0=(0.0, 0.0, 0.0),
        t_span=(55500.0, 55500.71912), h=0.00356, restitution=0.47,
        G=((-0.425, 0.148, -1.38), (-1.81, 0.753, 0.931), (0.0167, -1.09, 1.44)),
        offset=(3.487106106224562, -2.3623509023996054, -1.4110642563792035),
        K=((2290.0, 45.7, 7.73), (45.7, 14.3, -0.181), (7.73, -0.181, 0.0368)), constant=(0.0, 0.0, -0.0901),
        amplitude=(0.436, -0.218, 0.436), phase=(1.87, 1.87, 1.87), omega=12.5, bend=(-0.811, 0.225, 0.216),
        round=(0.3, 0.3, 0.0), general=True, spread=0.78, pendulum=1.62, b=(1.09, 0.637, -0.869), family="curved",
    )  # fmt: skip
    with warnings.catch_warnings():
        warnings.simplefilter("error", FastTurn)
        run = simulate(shaken.scene(), Located(shaken.h, tolerance=1e-5))
        finer = simulate(shaken.scene(), Located(shaken.h, tolerance=1e-7))  # it had ended in STEP_TOO_SMALL
    end = simulate(shaken.scene(), EventDriven(), keep=[shaken.t_span[1]])
    np.testing.assert_allclose(run.q[-1], end.q[-1], atol=1e-4)
    np.testing.assert_allclose(finer.q[-1], end.q[-1], atol=1e-6)
