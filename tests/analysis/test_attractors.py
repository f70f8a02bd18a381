"""Attractors, diagrams and basins: known maps first, then the findings of the thesis from the library's own eyes."""

import math
import re
from dataclasses import replace

import numpy as np
import pytest

from lagrangian import Harmonic, LinearContacts, LinearSystem, Scene
from lagrangian.scenes import ball_on_table, cam_follower, chaotic_oscillator, driven_bilinear_oscillator
from lagrangian.scenes.table import orbit_trace, sine_table
from lcpstep import EventDriven, Moreau
from lcpstep.analysis.attractors import attractors
from lcpstep.analysis.bifurcation import bifurcation
from lcpstep.analysis.likeness import Sample, likeness, sample
from lcpstep.analysis.lyapunov import lyapunov
from lcpstep.analysis.returns import in_the_end, return_time, return_times, settled_time, survive
from lcpstep.analysis.starts import outside, random_starts
from lcpstep.maps import periods
from tests.analysis.test_maps import table
from tests.marks import slow

BOX = [[0.0, -60.0], [1.5, 60.0]]
FIRST_DETACHMENT = 114.979  # rpm


def names(rpm, n=12, **settings):
    starts = np.vstack([[0.0, 0.0], random_starts(BOX, n, 1)])
    found = attractors(cam_follower(rpm=rpm), EventDriven(), starts, **({"window": 120} | settings))
    return {a.name: a for a in found.found}


@pytest.mark.slow
def test_exponents_of_known_maps():
    assert lyapunov(lambda x: 4.0 * x * (1.0 - x), [0.3], 20_000).largest == pytest.approx(
        math.log(2), abs=2e-3
    )
    A = np.array([[2.0, 1.0], [1.0, 1.0]])
    cat = lyapunov(lambda x: A @ x % 1.0, [0.1, 0.2], 3000)  # differenced across no jump of the map
    assert cat.largest == pytest.approx(math.log((3.0 + math.sqrt(5.0)) / 2.0), abs=1e-2)
    assert cat.chaotic
    stable = lyapunov(lambda x: 3.3 * x * (1.0 - x), [0.3], 4000, drop=500)
    assert stable.largest == pytest.approx(0.5 * math.log(abs(4.0 + 2.0 * 3.3 - 3.3**2)), abs=1e-3)
    assert not stable.chaotic


def test_return_times_of_the_logistic_map():
    for a, n in ((2.8, 1), (3.3, 2), (3.5, 4), (3.84, 3), (3.9, 0)):
        x = [0.3]
        for _ in range(3000):
            x.append(a * x[-1] * (1.0 - x[-1]))
        assert return_time(np.array(x[-200:])[:, None], 60, 1e-9) == n


@pytest.mark.parametrize(
    ("a", "dropped", "n"), [(2.98, 400, 1), (2.995, 1500, 1), (2.9, 90, 1), (3.01, 2000, 2)]
)
def test_a_motion_that_still_alternates_about_its_orbit_has_not_twice_its_period(a, dropped, n):
    # The multiplier 2 - a of the point of period one is near -1, and changes over two iterations are small
    x = [0.3]
    for _ in range(dropped + 400):
        x.append(a * x[-1] * (1.0 - x[-1]))
    states = np.array(x)[:, None]
    assert return_time(states[dropped : dropped + 240], 60, 1e-6) == 2
    assert settled_time(states[dropped : dropped + 240], 60, 1e-6) == (2 if n == 2 else 0)
    assert in_the_end(states[dropped : dropped + 240], 2) == n


@pytest.mark.parametrize(("transient", "name"), [(100, "unsettled"), (300, "O(1, 1)")])
def test_a_ball_just_below_its_flip_is_not_taken_for_one_of_period_two(transient, name):
    omega, r = 40.0, 0.5
    near, far = 0.00643, 0.0095  # [m]: the trace falls from one amplitude to the other
    for _ in range(60):  # until the multipliers are -0.9 and r^2 / -0.9
        amplitude = 0.5 * (near + far)
        above = orbit_trace(amplitude, omega, 9.81, r) > -0.9 - r**2 / 0.9
        near, far = (amplitude, far) if above else (near, amplitude)
    scene = ball_on_table(amplitude=amplitude, omega=omega, restitution=r)
    q, v = (float(np.ravel(x)[0]) for x in scene.exact(np.array([scene.period / 2.0])))
    (found,) = attractors(scene, EventDriven(), [[q + 1e-4, v - 0.01]], transient=transient, phase=0.5).found
    assert found.name == name
    assert found.lyapunov.largest == pytest.approx(math.log(0.9), abs=1e-4)


def test_the_ball_on_a_table_goes_to_its_orbit_of_period_one():
    found = attractors(table(A=0.01125, e=0.3), EventDriven(), [[0.05, 0.0], [0.06, 0.3]], transient=400)
    assert "O(1, 1)" in [a.name for a in found.found]


def test_findings_of_the_thesis_at_single_speeds():
    assert set(names(FIRST_DETACHMENT - 0.01)) == {"O(1, 0)"}  # never leaves the cam
    assert set(names(FIRST_DETACHMENT + 0.01)) == {"O(1, chattering)"}
    assert set(names(700.0)) == {"O(1, 1)"}
    coexisting = names(358.5, 40)
    assert set(coexisting) == {"O(3, 8)", "O(1, 2)"}
    # O(1, 2) in 8 log 0.8 / 4 per period: the determinant of the monodromy matrix is 0.8^4
    assert coexisting["O(1, 2)"].lyapunov.largest == pytest.approx(2.0 * math.log(0.8), abs=1e-6)
    assert coexisting["O(3, 8)"].lyapunov.largest == pytest.approx(8.0 / 3.0 * math.log(0.8), abs=1e-6)


def test_chaos_at_660_rpm():
    (found,) = names(660.0, 3).values()
    assert found.name == "chaotic"
    assert found.lyapunov.largest > 5.0 * found.lyapunov.error


def test_detachment_and_the_number_of_chattering_sequences_after_it():
    # How often the follower comes to rest on the cam within a period, by complete chattering
    def landings(rpm):
        return int(periods(cam_follower(rpm=rpm), EventDriven(), [0.0, 0.0], 12, drop=10).ends[0, -1])

    low, high = 114.0, 116.0
    while high - low > 1e-7:
        middle = 0.5 * (low + high)
        low, high = (middle, high) if landings(middle) == 0 else (low, middle)
    assert high == pytest.approx(FIRST_DETACHMENT, abs=1e-3)
    assert landings(high + 1e-3) == landings(125.0) == 2
    assert landings(150.0) == 1


def test_rounding_does_not_pass_for_an_attractor():
    # From rest on the cam the motion sticks now and then; in between it amplifies rounding errors to its own size,
    # so a cycle of sticking phases that closes in rounded arithmetic is none.
    assert set(names(358.5, 1, transient=600)) <= {"O(3, 8)", "O(1, 2)"}


@pytest.mark.parametrize("transient", slow([5, 20, 100], 20, 100))
def test_a_motion_on_its_way_has_no_name(transient):
    # Rounding closes cycles of 56 periods on the way to O(3, 8); the window is too short to leave one
    scene = cam_follower(rpm=358.5)
    found = attractors(
        scene, EventDriven(), random_starts(BOX, 60, 0), transient=transient, points=4000
    ).found
    assert {a.name for a in found} <= {"O(3, 8)", "O(1, 2)", "unsettled"}
    assert all("longer transient" in a.unsettled for a in found if not a.periods)


def test_a_motion_that_magnifies_rounding_before_it_sticks_has_no_period():
    # At 450 rpm rounding closes a cycle of 26 periods that sticks once; 1e-14 grows to the motion's size in between
    scene = cam_follower(rpm=450.0)
    run = periods(scene, EventDriven(), [0.3, 5.0], 2052, drop=2000)
    free = run.states[0, int(np.flatnonzero(run.ends[0])[0]) + 1]
    size = np.max(np.abs(run.states[0]), axis=0)
    near = periods(scene, EventDriven(), [free, free + 1e-14 * size], 24).states
    assert np.max(np.abs(near[1] - near[0]) / size) > 1e-2
    assert set(names(450.0, 6)) == {"aperiodic"}


def test_a_cycle_that_rounding_has_closed_does_not_survive_kicks():
    scene, n = cam_follower(rpm=358.5), np.array([56, 3, 1, 0])
    starts = outside(scene, random_starts(BOX, 100, 0), 0.0)
    runs = periods(scene, EventDriven(), starts, 340, drop=100)
    closed = return_times(runs.states, 60, np.full(len(starts), 1e-5))
    runs_of = [int(np.flatnonzero(closed == k)[0]) for k in n]
    states = runs.states[runs_of]
    kept = survive(scene, EventDriven(), states, n, 0.0, 1e-6 * np.max(np.abs(states), axis=(1, 2)))
    assert kept.tolist() == [False, True, True, False]


def test_time_stepping_finds_the_same_attractor_from_finer_steps():
    scene = cam_follower(rpm=700.0)
    h = scene.period / 2000
    found = attractors(scene, Moreau(h=h), random_starts(BOX, 10, 3), transient=300, window=120)
    assert found.found[0].name == "O(1, 1)"
    assert found.found[0].share >= 0.8


def test_forward_and_backward_diagrams_show_hysteresis():
    # The unstable branch of O(1, 1) beyond its nonsmooth fold at 673.23 rpm separates it from chaos
    speeds = np.linspace(665.0, 700.0, 8)
    down = bifurcation(cam_follower, "rpm", speeds, start="backward", x0=[1.33, -66.2], drop=150, keep=20)
    assert np.all(down["impacts"].sel(rpm=[680.0, 700.0]) == 1)
    assert np.ptp(down["v"].sel(rpm=665.0).values) > 1.0


def blocks(random, n, shift=0.0):
    phase = [random.normal(0.5 + shift, 0.1, 50) % 1.0 for _ in range(n)]
    return Sample(phase, [-random.exponential(1.0, 50) for _ in range(n)], 50, np.zeros((1, 2)))


@pytest.mark.slow
def test_samples_of_one_distribution_are_alike_and_of_two_are_not(monkeypatch):
    monkeypatch.setattr("lcpstep.analysis.likeness.RESAMPLES", 300)
    random = np.random.default_rng(0)
    same = [likeness(blocks(random, 40), blocks(random, 40)) for _ in range(12)]
    for name in ("phase", "velocity"):  # probabilities are uniform: a mean of twelve has a deviation of 0.08
        assert 0.2 < np.mean([x[name].p_value for x in same]) < 0.8
    other = likeness(blocks(random, 40), blocks(random, 40, shift=0.05))
    assert other["phase"].p_value < 0.01
    # Kuiper's distance of two normal distributions apart by half a standard deviation
    exact = 2.0 * 0.5 * (1.0 + math.erf(0.25 / math.sqrt(2.0))) - 1.0
    assert other["phase"].distance == pytest.approx(exact, abs=0.03)
    assert other["phase"].low <= other["phase"].distance <= other["phase"].high + 0.01


@pytest.mark.slow
def test_two_chaotic_runs_of_one_method_are_one_attractor():
    scene = cam_follower(rpm=660.0)
    a, b = (sample(scene, EventDriven(), x, 4000, drop=200) for x in ([0.4, 0.4], [0.9, -3.0]))
    found = likeness(a, b)
    assert min(x.p_value for x in found.values()) > 0.01


@pytest.mark.slow
def test_a_motion_that_was_not_waited_for_is_not_named_but_says_so():
    """The two multipliers of the bilinear oscillator turn, and their product is exp(-damping period)."""
    slow = driven_bilinear_oscillator(damping=0.03, omega=3.0)
    starts = random_starts([[-2.0, -4.0], [2.0, 4.0]], 4, seed=1)
    rate = -0.015 * slow.period
    early = attractors(slow, EventDriven(1e-9, 1e-9), starts, transient=50, points=2000).found[0]
    assert early.name == "unsettled"
    enough = int(re.search(r"take a transient of some (\d+) periods", early.unsettled)[1])
    assert enough == pytest.approx(math.log(1e-6) / rate, rel=0.3)
    late = attractors(slow, EventDriven(1e-9, 1e-9), starts, transient=int(1.2 * enough)).found[0]
    assert (late.name, late.unsettled) == ("O(2, 2)", "")
    assert late.lyapunov.largest == pytest.approx(rate, rel=1e-6)
    cam, box = cam_follower(rpm=358.5), [[0.0, -60.0], [1.5, 60.0]]
    found = attractors(
        cam, EventDriven(), random_starts(box, 12, seed=1), transient=200, longest=2, points=2000
    ).found
    assert {a.name for a in found} == {"unsettled", "O(1, 2)"}  # the other one is an O(3, 8)
    assert all("does not repeat within 2 periods" in a.unsettled for a in found if not a.periods)


def test_an_impact_on_the_section_is_told_from_a_long_transient():
    # The table of this scene is turned so that the ball of its periodic orbit lands at t = 0
    scene = ball_on_table(amplitude=0.0095)
    starts = random_starts([[0.0, -0.8], [0.06, 0.8]], 20, seed=0)
    reasons = {a.unsettled for a in attractors(scene, EventDriven(), starts).found if not a.periods}
    assert reasons == {"an impact falls on the section, now before it and now after it: take another phase"}
    moved = attractors(scene, EventDriven(), starts, phase=0.3).found
    assert "O(1, 1)" in [a.name for a in moved]
    assert next(a for a in moved if a.name == "O(1, 1)").lyapunov.largest == pytest.approx(np.log(0.5))


def test_a_motion_without_a_derivative_is_an_attractor_all_the_same():
    """A bar that falls flat on a shaken table: both feet strike together, and it does as a ball does."""
    omega, period = 35.0, 2.0 * math.pi / 35.0
    bar = Scene(
        LinearSystem(M=[[1.0, 0.0], [0.0, 1.0 / 3.0]], force=Harmonic(constant=[-9.81, 0.0])),
        q0=[0.02, 0.0], v0=[0.0, 0.0], t_span=(0.0, 1.0), p=[0.01, omega, 0.0], period=period,
        contacts=LinearContacts(G=[[1.0, 1.0], [1.0, -1.0]], restitution=0.2, motion=two_tables),
    )  # fmt: skip
    (found,) = attractors(
        bar, EventDriven(), [[0.02, 0.0, 0.0, 0.0]], transient=100, window=40, longest=10
    ).found
    ball = replace(
        bar, system=LinearSystem(M=1.0, force=Harmonic(constant=-9.81)), q0=0.02, v0=0.0,
        contacts=LinearContacts(G=1.0, restitution=0.2, motion=sine_table),
    )  # fmt: skip
    (one,) = attractors(ball, EventDriven(), [[0.02, 0.0]], transient=100, window=40, longest=10).found
    assert found.name == one.name
    assert found.points[:, [0, 2]] == pytest.approx(one.points, abs=1e-9)
    assert math.isnan(found.lyapunov.largest)
    assert "strike together" in found.lyapunov.reason


def two_tables(t, q, v, p, out):
    sine_table(t, q, v, p, out)
    out[1, 0], out[1, 1], out[1, 2] = out[0, 0], out[0, 1], out[0, 2]


def test_chaos_that_motions_leave_is_no_attractor():
    """All of 30 motions of this oscillator are periodic after 10 000 periods, and most are not after 740."""
    scene = chaotic_oscillator()
    starts = random_starts([[-1.0, -1.0], [0.3, 1.0]], 30, seed=0)
    later = periods(scene, EventDriven(), starts, 10_000, drop=9_999, most=0)
    assert not np.any(later.impacts)  # that without impacts is the periodic one
    found = attractors(scene, EventDriven(), starts)
    assert sorted(a.name for a in found.found) == ["O(1, 0)", "unsettled"]
    (one,) = (a for a in found.found if a.unsettled)
    assert "have become periodic" in one.unsettled
