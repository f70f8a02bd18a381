"""Heaps of discs with friction that fall together between two walls: by all methods alike, and no energy gained."""

from dataclasses import replace

import numpy as np
import pytest

from benchmarks.judge.coupled.heaps import heap
from benchmarks.judge.coupled.scenes import energy
from lcpstep import EventDriven, Kind, Located, Moreau, Status, simulate

METHODS = (
    EventDriven(1e-9, 1e-9, jamming="impact"),
    Located(5e-4),
    Located(4e-3, order=4),
    Located(1e-2, order=4, tolerance=1e-6),
)


@pytest.mark.parametrize(
    "seed",
    [110, 187, *(pytest.param(k, marks=pytest.mark.slow) for k in (17, 0, 2, 7, 26, 45, 52, 134, 225, 381))],
)
def test_heaps_settle_by_every_method_alike(seed):
    """What went wrong, by heap.

    0: an impact at a hop's end took one along that came 70 hops later. 2: hops faded until numbers had no digits, and
    their impacts no answer. 45: what only others press hopped on by rounding. 52: one that falls along a wall,
    unpressed, had what sticks decided by forces to come. 110, 225: accelerations that are rounding beside others
    left no forces. 134: a disc in a corner, whose two contacts stop together, stopped at one alone: with mu = 1 an
    impulse there moves nothing, and did not tell that the other goes with it. 187: a contact whose load had gone
    opened by rounding, and was missed by the next impact. 381: what rounding leaves of an impact was taken for speeds
    of other contacts, which are known better, until no impulses ended them.
    Heap 45 is compared before 0.6 s, for rounding makes 1e-2 of itself later: hops that meet are struck together.
    """
    true = simulate(heap(seed), METHODS[0])
    for method in METHODS[1:]:
        run = simulate(heap(seed), method)
        assert run.status == true.status == Status.DONE
        assert np.max(np.diff(energy(run))) < 1e-6
        t = 0.6 if seed == 45 else 1.0
        np.testing.assert_allclose(run.at(t)[0], true.at(t)[0], rtol=0, atol=3e-6)


def test_impulses_that_are_hard_to_find():
    """Contacts that hold each other at rest: every pivoting rule met a ray, in the heap of one step size."""
    assert simulate(heap(110), Located(1e-3)).status is Status.DONE


@pytest.mark.parametrize("tolerance", [1e-9, 1e-11])
def test_a_disc_that_rolls_up_a_wall_comes_back_to_the_floor(tolerance):
    """With mu = 1 the force of the floor, sliding, goes through the disc's contact with the wall, and stops nothing.

    Another disc presses it there. At 1e-11 what was left of a velocity, 1e-318, made contacts slip without end.
    """
    run = simulate(heap(316), EventDriven(tolerance, tolerance))
    assert run.status is Status.DONE
    np.testing.assert_allclose(run.q[-1], simulate(heap(316), Located(5e-4)).q[-1], rtol=0, atol=1e-6)


@pytest.mark.parametrize("seed", [0, 3, 4, 7])
def test_a_contact_whose_load_has_gone_stays_whatever_the_rounding(seed):
    """A disc stops turning between wall and floor: nothing presses it on the wall or takes it away.

    Friction that has nothing to hold is rounding of the largest forces of the heap, and opened it in every third
    start moved by so little; the next disc then struck the floor first, and came to lie 0.1 m from there.
    """
    q0 = heap(187).q0 + 1e-13 * np.random.default_rng(seed).standard_normal(18)
    moved = replace(heap(187), q0=q0, t_span=(0.0, 0.4))
    true, run = simulate(moved, METHODS[0], keep=[0.4]), simulate(moved, METHODS[1], keep=[0.4])
    corner = true.impacts[true.impacts.contact == 22]
    assert not np.any(corner.kind == Kind.RELEASE)
    np.testing.assert_allclose(run.q[-1], true.q[-1], rtol=0, atol=1e-5)


def test_a_blow_elsewhere_opens_nothing_that_rests():
    """A disc slides down a wall, to which rounding has left it a speed of 1e-80, when another lands.

    Opened by that, it struck the floor as if without the wall that it touches, and came to lie 0.04 m from there.
    """
    run, true = simulate(heap((11, 29)), EventDriven()), simulate(heap((11, 29)), Located(5e-4, order=4))
    np.testing.assert_allclose(run.q[-1], true.q[-1], rtol=0, atol=1e-11)


@pytest.mark.slow
@pytest.mark.parametrize("seed", [449, 451])
def test_heaps_that_jam_go_on_as_by_moreaus_steps_from_just_before(seed):
    """No forces answer what slides in them, as an enumeration of all modes says, nor would one contact alone jam."""
    asked = EventDriven(1e-10, 1e-10, jamming="impact")
    assert simulate(heap(seed), EventDriven(1e-10, 1e-10)).status is Status.PAINLEVE_INCONSISTENT
    run = simulate(heap(seed), asked)
    assert run.status is Status.DONE
    assert np.max(np.diff(energy(run))) < 1e-6
    t = run.impacts.time[run.impacts.kind == Kind.JAM][0]
    q, v = run.at(t - 1e-6)[:2]
    near = replace(heap(seed), q0=q, v0=v, t_span=(t - 1e-6, t + 1e-4))
    ends = [simulate(near, method, keep=[t + 1e-4]).q[-1] for method in (asked, Moreau(1e-5), Moreau(1e-6))]
    assert np.max(np.abs(ends[2] - ends[0])) < 0.5 * np.max(np.abs(ends[1] - ends[0])) + 1e-10
