"""Planar friction event by event, against what physics allows and Moreau's scheme: energy, cones, paradoxes."""

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from lagrangian import Coulomb, Joints, LinearContacts, Scene, System, scenes
from lagrangian.scenes.rough_contacts import critical_friction
from lcpstep import EventDriven, Kind, Moreau, Status, continued, simulate
from lcpstep import energy as energy_balance
from tests.events.rough import block, energy, rod, rod_row, times, weight
from tests.marks import shared
from tests.uncompiled import both_ways


def at_end(scene, *methods):
    """Positions at the end of the span by these methods."""
    return [simulate(scene, method, keep=[scene.t_span[1]]).q[-1] for method in methods]


# --- what no friction may do


@settings(max_examples=30, deadline=None)
@given(st.integers(0, 10**6))
def test_energy_never_grows_impulses_lie_in_the_cone_and_nothing_is_passed(seed):
    scene = block(seed)
    run = simulate(scene, EventDriven(1e-11, 1e-11))
    assert run.status == Status.DONE, run.message
    E = energy(scene, run.q, run.v)
    assert np.max(np.diff(E)) < 1e-8 * (1.0 + E[0])
    assert np.min(run.impulse) > -1e-9
    assert np.all(np.abs(run.friction_impulse) <= scene.contacts.friction.mu * run.impulse + 1e-8)
    assert np.max(run.penetration) < 1e-8


@pytest.mark.parametrize("seed", shared(range(12), 3))
def test_moreaus_scheme_comes_to_the_same_motion(seed):
    scene = block(seed)
    exact, coarse, fine = at_end(scene, EventDriven(1e-10, 1e-10), Moreau(2e-4), Moreau(2e-6))
    assert np.max(np.abs(fine - exact)) < 0.2 * np.max(np.abs(coarse - exact)) + 2e-6


@pytest.mark.parametrize("seed", [3, 8, 21])
def test_the_motion_does_not_depend_on_what_is_kept(seed):
    scene, method = block(seed), EventDriven(1e-10, 1e-10)
    whole, some = simulate(scene, method), simulate(scene, method, keep=[0.3, 1.0])
    assert np.allclose(whole.q[-1], some.q[-1], rtol=0.0, atol=1e-14)
    assert np.array_equal(whole.impacts.kind, some.impacts.kind)
    assert np.allclose(whole.impacts.time, some.impacts.time, rtol=0.0, atol=1e-14)
    assert np.allclose(
        np.sum(whole.friction_impulse, axis=0), np.sum(some.friction_impulse, axis=0), atol=1e-13
    )
    assert np.allclose(whole.at(0.3)[0], some.q[0], atol=1e-12)


# --- several contacts, joints, obstacles that move


def test_a_pendulum_drags_along_a_wall():
    scene = Scene(
        system=System(2, np.eye(2), weight), joints=Joints(1, rod, rod_row),
        contacts=LinearContacts([[1.0, 0.0]], restitution=0.4, friction=Coulomb(0.3, [[0.0, 1.0]])),
        q0=[math.sin(1.0), -math.cos(1.0)], v0=[0.0, 0.0], t_span=(0.0, 2.0),
    )  # fmt: skip
    exact, coarse, fine = at_end(scene, EventDriven(1e-11, 1e-11), Moreau(1e-3), Moreau(1e-5))
    assert np.max(np.abs(fine - exact)) < 0.05 * np.max(np.abs(coarse - exact)) + 1e-6


def test_the_woodpecker_pecks_seven_times_a_second_whatever_the_tolerance():
    scene = scenes.woodpecker()
    run, again = (simulate(scene, EventDriven(tol, tol)) for tol in (1e-12, 1e-9))
    pecks = times(run, Kind.IMPACT)
    assert np.all(np.abs(np.diff(pecks) - 0.14596) < 2e-4)
    assert np.max(np.abs(run.q[-1] - again.q[-1])) < 1e-8
    errors = [np.max(np.abs(q - run.q[-1])) for q in at_end(scene, Moreau(1e-4), Moreau(1e-5), Moreau(1e-6))]
    assert errors[1] < 0.2 * errors[0]
    assert errors[2] < 0.2 * errors[1]


# --- Painleve


@settings(max_examples=20, deadline=None)
@given(st.floats(0.3, 1.4), st.floats(0.9, 1.1))
def test_a_rod_that_jams_is_named_with_its_critical_coefficient(angle, share):
    mu = share * critical_friction(angle)
    run = simulate(scenes.falling_rod(mu=mu, angle=angle, t_end=1e-3), EventDriven())
    if share > 1.0 + 1e-9:
        assert run.status == Status.PAINLEVE_INCONSISTENT
        said = float(run.message.split("state: ")[1].split(")")[0])
        assert abs(said - critical_friction(angle)) < 1e-7
    elif share < 0.99:
        assert run.status == Status.DONE


def test_no_rod_jams_below_four_thirds():
    angles = np.linspace(0.05, 1.5, 500)
    assert min(critical_friction(a) for a in angles) >= 4.0 / 3.0
    assert abs(critical_friction(math.atan(2.0)) - 4.0 / 3.0) < 1e-14
    for angle in (0.8, 1.1, 1.3):
        assert simulate(scenes.falling_rod(mu=1.3, angle=angle), EventDriven()).status == Status.DONE


def test_a_rod_that_lifts_off_or_stays_is_indeterminate():
    """Turning fast, the tip would lift off; pressed by friction it could as well stay."""
    scene = scenes.falling_rod(mu=2.0, angle=1.1)
    turning = Scene(
        system=scene.system, contacts=scene.contacts, q0=scene.q0, p=scene.p, t_span=(0.0, 0.1),
        v0=[-4.0, 0.5 * math.cos(1.1) * 6.0, 6.0],
    )  # fmt: skip
    assert simulate(turning, EventDriven()).status == Status.PAINLEVE_INDETERMINATE


# --- what is made of such runs


def test_a_run_with_friction_goes_on_from_its_end():
    scene = scenes.coulomb_oscillator(t_end=5.0)
    first = simulate(scene, EventDriven())
    second = simulate(continued(first, t_end=20.0), EventDriven())
    whole = simulate(scenes.coulomb_oscillator(), EventDriven())
    assert np.max(np.abs(second.q[-1] - whole.q[-1])) < 1e-11


def test_the_energy_that_friction_takes_never_comes_back():
    for scene in (scenes.sliding_block(), scenes.slope_landing(), scenes.slider_crank()):
        E = energy_balance(simulate(scene, EventDriven(1e-11, 1e-11)))
        assert np.min(np.diff(E.friction)) > -1e-8
        assert len(E.created) == 0
    E = energy_balance(simulate(scenes.sliding_block(), EventDriven()))
    assert abs(E.friction[-1] - 0.5) < 1e-12


PROGRAM = """
from lagrangian import scenes
from lcpstep import EventDriven, simulate

for scene in (scenes.coulomb_oscillator(t_end=4.0), scenes.woodpecker(t_end=0.04)):
    run = simulate(scene, EventDriven(rtol=1e-7, atol=1e-7), keep=1)
    print(len(run.t), run.counts, *(float(x).hex() for x in (*run.q[-1], *run.v[-1], *run.impacts.impulse)))
"""


@pytest.mark.slow
def test_the_kernels_as_plain_python_give_the_same():
    built, plain = both_ways(PROGRAM)
    assert built == plain
