"""Contacts that are struck in every second step as fast as the motion is: the run says so, and only then."""

import math

import numpy as np
import pytest

from benchmarks.judge.describe import Description
from lagrangian import LinearContacts, LinearSystem, Scene, System, scenes
from lcpstep import EventDriven, Located, Moreau, simulate
from lcpstep.doubts.hops import too_short
from lcpstep.trajectory import Status

TOLD = "is struck in every second step"


START = 0.4  # from the edge


def wedge(angle, height, as_general=False):
    """A point of 1 kg that flies at 1 m/s into the edge of two smooth elastic walls, and out again."""
    rows = [[0.0, 1.0], [math.sin(angle), -math.cos(angle)]]
    system = System(2, np.eye(2), nothing) if as_general else LinearSystem(np.eye(2))
    walls = LinearContacts(rows, 0.0, 1.0)
    return Scene(system, q0=[START, height], v0=[-1.0, 0.0], t_span=(0.0, 2.0 * START), contacts=walls)


def nothing(t, q, v, p, out):
    out[0] = out[1] = 0.0


def reflected(angle, height, t):
    """Where it is: on a straight line in a plane that is folded along the walls."""
    x, y = START - t, np.full_like(t, height)
    turned = np.arctan2(y, x) % (2.0 * angle)
    turned = np.where(turned > angle, 2.0 * angle - turned, turned)
    return np.hypot(x, y)[:, None] * np.column_stack([np.cos(turned), np.sin(turned)])


@pytest.mark.parametrize("as_general", [False, True])
@pytest.mark.parametrize(("angle", "height", "h"), [(0.1, 0.02, 0.02), (0.1, 0.005, 0.02)])
def test_a_wedge_into_which_steps_are_too_long_is_told(angle, height, h, as_general):
    scene = wedge(angle, height, as_general)
    exact = simulate(scene, EventDriven())
    assert np.max(np.abs(exact.q - reflected(angle, height, exact.t))) < 1e-11
    run = simulate(scene, Moreau(h))
    assert np.max(np.abs(run.q - reflected(angle, height, run.t))) > 0.3
    assert run.status is Status.DONE
    assert TOLD in run.doubt
    assert TOLD in run.message
    assert exact.doubt == simulate(scene, Located(h)).doubt == ""


@pytest.mark.parametrize(("angle", "height"), [(0.3, 0.05), (0.1, 0.02), (0.05, 0.01)])
def test_a_wedge_that_steps_resolve_is_not_told(angle, height):
    scene = wedge(angle, height)
    for h in (1e-3, 1e-4):
        run = simulate(scene, Moreau(h))
        assert np.max(np.abs(run.q - reflected(angle, height, run.t))) < 40.0 * h
        assert run.doubt == ""


@pytest.mark.parametrize(
    "keep", [1, 3, "impacts", np.linspace(0.0, 0.8, 41)], ids=["all", "third", "impacts", "times"]
)
def test_what_is_kept_makes_no_difference(keep):
    run = simulate(wedge(0.1, 0.02), Moreau(0.02), keep=keep)
    assert (TOLD in run.doubt) is (len(run.t) >= 16)
    assert simulate(wedge(0.1, 0.02), Moreau(1e-3), keep=keep).doubt == ""


def slit(clearance, h):
    """Between two elastic walls, beside a coordinate that goes on."""
    return Scene(
        LinearSystem(np.eye(2)), q0=[0.0, 0.0], v0=[1.0, 0.3], t_span=(0.0, 100 * h),
        contacts=LinearContacts([[1.0, 0.0], [-1.0, 0.0]], [0.0, clearance], 1.0),
    )  # fmt: skip


@pytest.mark.parametrize("clearance", [0.0, 0.003])
def test_a_body_that_does_nothing_but_hop_is_where_it_is_to_the_order(clearance):
    h = 0.01
    run = simulate(slit(clearance, h), Moreau(h))
    assert len(run.impacts) > 90  # one wall or the other in every step
    assert np.max(np.abs(run.q[:, 0])) <= clearance + 1.01 * h
    np.testing.assert_allclose(run.q[:, 1], 0.3 * run.t, rtol=1e-12)
    assert run.doubt == ""


def test_hops_that_are_low_beside_the_motion_are_not_told():
    """A ball of restitution 0.9 comes to rest by hops of two steps, and one that slides hops all the way."""
    ball = scenes.bouncing_ball(t_end=6.0)
    assert simulate(ball, Moreau(1e-3)).doubt == simulate(ball, Moreau(2e-2)).doubt == ""
    h, slope = 0.03, np.array([math.sin(0.3), math.cos(0.3)])
    scene = Scene(
        LinearSystem(np.eye(2), force=[0.0, -9.81]), q0=[0.0, 0.0], v0=0.1 * slope, t_span=(0.0, 3.0),
        contacts=LinearContacts([slope], 0.0, 1.0),
    )  # fmt: skip
    run = simulate(scene, Moreau(h))
    assert len(run.impacts) > 40
    true = simulate(scene, EventDriven()).at(run.t)[0]
    assert np.max(np.abs(run.q - true)) < 0.02 * np.max(np.abs(true))
    assert run.doubt == ""


# 49 g beside 22 t on a sphere, between two elastic walls: 12 790 impacts, as close as 3e-6 s
SQUEEZED = Description(
    M=((21900.0, 0.0, 0.0), (0.0, 77.7, 0.0), (0.0, 0.0, 0.0489)), q0=(0.582, 2.25, 1.45),
    v0=(0.1320367793378329, -0.9473969870960073, 1.4171019416492399), t_span=(0.0, 9.4526), h=0.0626,
    G=((-0.473, -0.794, 0.841), (0.548, 1.64, 0.165)), offset=(0.8423360000000002, -4.2481860000000005),
    restitution=1.0, K=((1390.0, -123.0, 3.02), (-123.0, 49.1, -0.477), (3.02, -0.477, 0.0167)),
    constant=(0.0, 0.0, -0.48), J=((0.0, 0.0, 0.0),), joint_offset=(-3.751862,), joint_bend=(1.0,),
)  # fmt: skip


def test_thousands_of_impacts_in_a_few_steps_are_told():
    scene = SQUEEZED.scene()
    run, true = simulate(scene, Moreau(SQUEEZED.h)), simulate(scene, EventDriven())
    assert len(true.impacts) > 80 * len(run.impacts)
    assert np.max(np.abs(run.q - true.at(run.t)[0])) > 0.3
    assert TOLD in run.doubt


def test_runs_that_are_not_asked():
    """By a tolerance, by other methods, and those that did not come to their end."""
    scene = wedge(0.1, 0.02)
    assert too_short(simulate(scene, Moreau(0.02, tolerance=1e-2))) == ""
    assert too_short(simulate(scene, Located(0.02))) == too_short(simulate(scene, EventDriven())) == ""
