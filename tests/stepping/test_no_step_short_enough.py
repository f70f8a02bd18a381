"""Steps by a tolerance where none was short enough: slow approaches that make large velocities jump, and no room."""

import math
from dataclasses import replace

import numpy as np
import pytest

from benchmarks.judge.describe import Description
from lagrangian import Harmonic, LinearContacts, LinearSystem, Scene, System
from lcpstep import EventDriven, Located, Moreau, Status, simulate
from tests.marks import slow

# Four coordinates between four planes in a shaking frame, in units in which a gap's speed of 1.4e-5 makes velocities
# jump by 5e-4
SHAKEN = Description(
    M=((0.015625, 0.0, 0.0, 0.0), (0.0, 0.25, 0.0, 0.0), (0.0, 0.0, 64.0, 0.0), (0.0, 0.0, 0.0, 0.25)),
    q0=(10.32, 1.156, -0.016, 2.92), v0=(0.0, 0.0, 0.0, 0.0), t_span=(95300.0, 95304.45945), h=0.00583,
    G=((-0.063125, -0.03905, 2.16, -0.0153), (0.016375, -0.3225, 8.8, -0.87), (0.33875, -0.1075, -0.7192, 0.515),
    (-0.0093625, -0.52, -4.92, 0.274)), offset=(0.7758278000000001, 2.88502, -4.8869372, -0.18105900000000003),
    restitution=0.45, C=((0.0003125, 0.0, 0.0, 0.0), (0.0, 0.005, 0.0, 0.0), (0.0, 0.0, 1.28, 0.0), (0.0, 0.0, 0.0,
    0.005)), constant=(-0.0915, -0.0585, -5.216, 0.1805), frame=(-0.1456, -0.0264, -0.00018625, 0.0258), omega=5.18,
)  # fmt: skip

# A dome that closes in on its body; the gap of contact 1 is 1.862 - 1.66 sqrt(1 + q^2) - 0.264 sin(11 t)
DOME = Description(
    M=((257.0,),), q0=(-0.508,), v0=(0.0,), t_span=(0.0, 0.1246), h=0.0089, G=((0.0,), (0.0,), (0.0,)),
    offset=(3.2323585074017727, 1.8619133058228035, 0.20645120000000003), restitution=(0.37, 0.9, 0.0), K=((74.7,),),
    constant=(-2520.0,), amplitude=(0.264, 0.264, 0.0), omega=11.0, bend=(-1.36, -1.66, -1.6), phase=(0.0, 0.0, 0.0),
    round=(0.3, 1.0, 0.0), general=True, pendulum=8.12, b=(-1.34,),
)  # fmt: skip


@pytest.mark.parametrize("tolerance", [3e-2, 1e-2, 3e-3, 1e-3])
def test_a_slow_approach_that_makes_velocities_jump_is_an_impact(tolerance):
    t = np.linspace(*SHAKEN.t_span, 200)
    reference = simulate(SHAKEN.scene(), EventDriven(1e-10, 1e-10), keep=t)
    m = simulate(SHAKEN.scene(), Moreau(8 * SHAKEN.h, tolerance=tolerance), keep=t)
    assert m.status == Status.DONE, m.message
    assert np.max(np.abs(m.q - reference.q)) <= tolerance * (1.0 + np.max(np.abs(reference.q)))


def test_events_without_end_at_one_instant_are_not_asked_for_by_ever_shorter_steps():
    most = 2000
    m = simulate(DOME.scene(), Located(8 * DOME.h, tolerance=1e-4, max_events=most))
    assert m.status == Status.TOO_MANY_EVENTS
    assert m.t[-1] == pytest.approx(math.asin((DOME.offset[1] - 1.66) / 0.264) / 11.0, rel=1e-9)
    assert m.counts.lcp_calls < 16 * most  # 28 times `most` before


# A plate on a shaken obstacle comes slowly to three walls at one place
CARRIED = Description(
    M=((1.91,),), q0=(0.182,), v0=(0.0,), t_span=(0.0, 2.3108), h=0.0212, G=((1.5,), (1.5,), (4.5,), (12.0,)),
    offset=(-0.273, -0.273, -0.819, -2.184217601540599), restitution=(0.034, 0.32, 0.0, 0.061), K=((0.308,),),
    C=((0.0382,),), constant=(0.056056,), sine=(-1.44,), force_omega=1.43, amplitude=(0.0, 0.0, 0.0, -0.00089),
    phase=(0.0, 0.0, 0.0, 0.247), omega=5.19,
)  # fmt: skip


@pytest.mark.parametrize("tolerance", slow([1e-3, 1e-4, 1e-6], 1e-3))
def test_an_error_that_was_accepted_is_not_counted_again_in_the_next_step(tolerance):
    """The impact is late by what the tolerance allows; the gap beside it is twelve times as steep as the wall's."""
    for end in np.arange(1.5, 3.0, 0.05):
        scene = replace(CARRIED, t_span=(0.0, end)).scene()
        m = simulate(scene, Located(0.17, tolerance=tolerance))
        assert m.status == Status.DONE, (end, m.message)
        true = simulate(scene, EventDriven(), keep=m.t).q
        assert np.max(np.abs(m.q - true)) <= tolerance


def pushed_later(t, q, v, p, out):
    """The force turns about; at that time it is already the new one."""
    out[0] = 3.0 if t >= p[0] else -3.0


@pytest.mark.parametrize("at", [0.1875, 0.19, 0.25, 0.5, 0.999])
@pytest.mark.parametrize("h", [0.1, 0.5])
@pytest.mark.parametrize("tolerance", [1e-2, 1e-3, 1e-5])
def test_a_force_may_jump_where_steps_of_every_size_end(at, h, tolerance):
    """Each step that ends there meets the new force; its first half does not, and the second did so no less."""
    scene = Scene(System(1, 1.0, pushed_later), 0.0, 0.0, (0.0, 1.0), p=[at], corners=[at])
    m = simulate(scene, Moreau(h, tolerance=tolerance))
    assert m.status == Status.DONE, m.message
    assert m.q[-1, 0] == pytest.approx(
        -1.5 * at**2 - 3.0 * at * (1.0 - at) + 1.5 * (1.0 - at) ** 2, abs=tolerance
    )
    assert m.v[-1, 0] == pytest.approx(3.0 - 6.0 * at, abs=tolerance)
    assert m.counts.steps < 1000


def pressed(t, q, v, p, out):
    out[0] = -28.0


def two_tables(t, q, v, p, out):
    """Both swing; the one below the body from time 0 is overtaken by the other."""
    for i in range(2):
        a, phase = p[2 * i], p[2 * i + 1]
        out[i, 0] = a * (math.sin(8.0 * t + phase) - math.sin(phase))
        out[i, 1], out[i, 2] = 8.0 * a * math.cos(8.0 * t + phase), -64.0 * a * math.sin(8.0 * t + phase)


@pytest.mark.parametrize("tolerance", [1e-3, 5e-4, 2e-4, 1e-4, 1e-5])
def test_a_late_impact_that_closes_and_throws_off_a_neighbour_is_not_counted_again(tolerance):
    """The impact is late by what the tolerance allows, and the body rises by that when the next step begins."""
    for end in np.arange(0.3, 0.6, 0.01):
        scene = Scene(
            System(1, 1.0, pressed), 0.0, 0.74, (0.0, end), p=[-0.375, 0.8125, -0.125, -1.125],
            contacts=LinearContacts([[1.0], [2.0]], 0.0, 0.0, motion=two_tables),
        )  # fmt: skip
        m = simulate(scene, Located(0.77 * end, tolerance=tolerance))
        assert m.status == Status.DONE, (end, m.message)
        true = simulate(scene, EventDriven(), keep=m.t).q
        assert np.max(np.abs(m.q - true)) <= tolerance


def thrown_back(t, q, v, p, out):
    """A constant force that acts beyond a place only."""
    out[0] = -p[1] if q[0] > p[0] else 0.0


@pytest.mark.parametrize("tolerance", [1e-8, 1e-9])
@pytest.mark.parametrize(
    ("place", "push"), [(0.059457945379626315, 36.22662203461734), (0.3279264351147266, 49.37656532355835)]
)
def test_a_force_may_jump_anywhere_within_a_step(place, push, tolerance):
    """The halves of a step that hold the jump, first or second in any order, are compared with the step itself."""
    scene = Scene(System(1, 1.0, thrown_back), 0.0, 1.0, (0.0, 1.0), p=[place, push])
    m = simulate(scene, Located(0.1, order=4, tolerance=tolerance))
    assert m.status == Status.DONE, m.message
    back = place + 2.0 / push  # it is there again, as fast as it came
    assert m.q[-1, 0] == pytest.approx(place - (1.0 - back), abs=tolerance)
    assert m.v[-1, 0] == pytest.approx(-1.0, abs=tolerance)


@pytest.mark.parametrize("tolerance", [1e-2, 1e-3, 1e-4])
@pytest.mark.parametrize("theta", [0.5, 0.75, 1.0])
def test_a_body_thrown_between_two_walls_without_clearance_comes_to_rest_between_them(theta, tolerance):
    """What stops it at one wall had counted as a force on the other, that it had just left: many runs ended."""
    rng = np.random.default_rng(1198)
    for _ in range(8):
        mass, v, constant, sine, omega = rng.uniform([0.1, 1.0, -5.0, -5.0, 1.0], [10.0, 4.0, 5.0, 5.0, 10.0])
        walls = LinearContacts(
            [[1.0], [-1.0]], restitution=rng.choice([0.3, 0.5, 0.8, 1.0], 2, replace=False)
        )
        force = Harmonic(constant, sine=sine, omega=omega)
        run = simulate(
            Scene(LinearSystem(mass, force=force), 0.0, v, (0.0, 1.0), walls),
            Moreau(1.0, theta, tolerance=tolerance),
        )
        assert run.status is Status.DONE, run.message
        assert np.max(np.abs(run.q)) <= 2.0 * tolerance
        assert abs(run.v[-1, 0]) <= tolerance


def test_a_force_that_begins_at_zero_at_time_zero():
    """Steps are halved until they are no time; at time zero no number of seconds is rounding of it."""
    d = Description(
        M=((1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0)), q0=(-0.0756, 0.756, 0.565), v0=(0.0, 0.0, 0.0),
        t_span=(0.0, 0.1755), h=0.00117, G=((2.5, -2.16, -0.42), (-1.64, -0.8, -0.861)), offset=(2.18726, 0.967281),
        restitution=(0.3, 0.0), K=((123.0, 344.0, 94.6), (344.0, 1270.0, 335.0), (94.6, 335.0, 148.0)),
        constant=(304.0102, 1123.1936, 329.55823999999996), cosine=(0.204, 0.195, 0.17), force_omega=1.1,
        J=((0.6, 0.9, 1.1), (1.2, 1.8, -0.7)), joint_offset=(-1.25654, -0.8745800000000001), general=True,
    )  # fmt: skip
    m = simulate(d.scene(), Located(8.0 * d.h, 4, tolerance=1e-6))
    assert m.status is Status.DONE
    np.testing.assert_allclose(m.q[-1], simulate(d.scene(), EventDriven()).q[-1], atol=1e-8)


def dragged(t, q, v, p, out):
    out[0] = -9.0 - 0.5 * v[0]


def growing(t, q, v, p, out):
    out[0, 0] = 1.0 + 0.3 * np.sin(q[0])


@pytest.mark.parametrize("mass", [[[1.0]], growing], ids=["constant", "varying"])
def test_an_impact_of_a_general_system_is_found_to_the_smallest_tolerances(mass):
    """What its forces do in ever shorter steps is not hidden by rounding of the jump."""
    ball = System(1, mass, dragged)
    scene = Scene(ball, 0.3, -1.0, (0.0, 0.5), LinearContacts(1.0, 0.0, 0.8))
    m = simulate(scene, Moreau(0.01, tolerance=1e-7))
    assert m.status == Status.DONE, m.message
    assert m.q[-1, 0] == pytest.approx(simulate(scene, EventDriven()).q[-1, 0], abs=1.3e-7)


def steep(t, q, v, p, out):
    out[0, 0] = math.exp(p[0] * q[0])


def falls_and_turns(t, q, v, p, out):
    out[0] = -(0.5 * p[0] * v[0] ** 2 + 9.81) * math.exp(p[0] * q[0])


@pytest.mark.parametrize(("steepness", "h"), [(3.0, 0.1), (6.0, 0.1), (10.0, 0.03)])
def test_a_mass_that_grows_many_times_over_a_step_is_iterated_for(steepness, h):
    """From where it was thrown down it strikes the floor, and loses what the law of impact takes."""
    ball = System(1, steep, falls_and_turns)
    scene = Scene(ball, 0.5, -5.0, (0.0, 2.0), LinearContacts(1.0, 0.0, 0.9), p=[steepness])
    m = simulate(scene, Moreau(h))
    assert m.status == Status.DONE, m.message
    first = m.impacts[0]
    assert first.after == pytest.approx(-0.9 * first.before, rel=1e-9)
