"""Maps: known ones iterate as they must, and those of scenes agree with single runs of both integrators."""

import math
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st

from lagrangian import Harmonic, LinearContacts, LinearSystem, Scene, System, scenes
from lcpstep import EventDriven, Kind, Moreau, simulate
from lcpstep.analysis.attractors import NoneSettled, attractors
from lcpstep.errors import LcpStepError
from lcpstep.maps import ImpactMap, NoReturn, StroboscopicMap, iterate, periods
from lcpstep.maps.batch import INSIDE, Targets
from lcpstep.maps.one_by_one import continued

REST = [0.0, 0.0]


def test_iterating_the_logistic_map_at_four_has_its_closed_form():
    angle = 0.3
    orbit = iterate(lambda x: 4.0 * x * (1.0 - x), [math.sin(angle) ** 2], 20)
    assert orbit[:, 0] == pytest.approx(np.sin(2.0 ** np.arange(21) * angle) ** 2, abs=1e-9)


def test_iterating_a_linear_map_is_a_power_of_its_matrix():
    A = np.array([[0.8, -0.5], [0.3, 0.9]])
    assert iterate(lambda x: A @ x, [1.0, 2.0], 9)[-1] == pytest.approx(
        np.linalg.matrix_power(A, 9) @ [1.0, 2.0]
    )


@pytest.mark.parametrize("coordinates", ["relative", "absolute"])
@given(
    starts=st.lists(
        st.tuples(st.floats(0.0, 1.0), st.floats(-50.0, 50.0)), min_size=1, max_size=5, unique=True
    ),
    phase=st.sampled_from([0.0, 0.37]),
    h=st.sampled_from([1e-3, 0.7e-3]),
)
@example(starts=[(0.1875, 12.0)], phase=0.0, h=1e-3)
@settings(max_examples=15, deadline=None)
def test_time_stepping_in_lockstep_is_single_runs_bit_for_bit(coordinates, starts, phase, h):
    scene, x = scenes.cam_follower(rpm=358.5, coordinates=coordinates), np.array(starts)
    t = phase * scene.period
    relative = scenes.cam_follower(rpm=358.5)
    c = np.zeros((1, 3))
    if coordinates == "absolute":
        relative.system.frame(t, REST, REST, relative.p, c)
    x += c[0, :2]
    x[:, 0] += 1e-12
    found = periods(scene, Moreau(h=h), x, 2, phase=phase)
    for i, start in enumerate(x):
        touching = False
        for k in range(2):
            span = (t, t + scene.period)
            run = simulate(continued(scene, start, span), Moreau(h=h))
            start = np.concatenate([run.q[-1], run.v[-1]])
            assert np.array_equal(found.states[i, k], start)
            impacts = run.impacts[run.impacts.kind == Kind.IMPACT]
            if touching and len(impacts) and impacts.time[0] < t + 1.5 * h:
                impacts = impacts[1:]  # contact that lasts from one period into the next is no second impact
            touching = run.impulse[-1, 0] > 0.0
            assert found.impacts[i, k] == len(impacts)
            for name, values in {"time": found.time, "before": found.before, "after": found.after}.items():
                assert np.array_equal(values[i, k, : len(impacts)], impacts[name])


def test_following_many_event_driven_runs_at_once_agrees_with_single_ones():
    scene = scenes.cam_follower(rpm=125.0)  # chatters and sticks
    starts = np.array([[0.4, 0.4], [0.0, 0.0], [0.1, -3.0]])
    found = periods(scene, EventDriven(), starts, 3)
    for i, start in enumerate(starts):
        for k in range(3):
            span = (0.0, scene.period)
            run = simulate(
                replace(scene, q0=start[:1], v0=start[1:], t_span=span), EventDriven(), keep="impacts"
            )
            start = np.concatenate([run.q[-1], run.v[-1]])
            assert found.states[i, k] == pytest.approx(start, abs=1e-9)
            kinds, later = run.impacts.kind, run.impacts.time > 0.0  # closed at the section is no landing
            landings = np.sum((kinds == Kind.STICK) & later)
            assert (found.impacts[i, k], found.ends[i, k]) == (np.sum(kinds == Kind.IMPACT), landings)
    assert np.all(found.ends[:, 1:] > 0)


def test_a_run_of_n_periods_is_n_iterations_to_the_last_bit():
    P = StroboscopicMap(scenes.cam_follower(rpm=660.0), EventDriven(), phase=0.25)
    assert np.array_equal(iterate(P, [0.4, 0.4], 5)[1:], P.follow([0.4, 0.4], 5).states[0])


def test_without_contact_the_map_of_an_oscillator_is_affine_and_known():
    # x'' + w^2 x = cos(t): one period turns the deviation from the steady motion by the angle 2 pi w
    w = 0.3
    scene = Scene(
        LinearSystem(M=1.0, K=w * w, force=Harmonic(cosine=1.0, omega=1.0)), q0=0.0, v0=0.0,
        t_span=(0.0, 1.0), contacts=LinearContacts(G=1.0, offset=1e3), period=2.0 * math.pi,
    )  # fmt: skip
    steady, angle = 1.0 / (w * w - 1.0), 2.0 * math.pi * w
    x = np.array([2.0, -0.5])
    d = x - [steady, 0.0]
    turned = [
        d[0] * math.cos(angle) + d[1] / w * math.sin(angle),
        -d[0] * w * math.sin(angle) + d[1] * math.cos(angle),
    ]
    expected = turned + np.array([steady, 0.0])
    assert StroboscopicMap(scene, EventDriven())(x) == pytest.approx(expected, abs=1e-12)
    # The theta-method without damping: an error of the second order
    errors = [np.max(np.abs(StroboscopicMap(scene, Moreau(h=h))(x) - expected)) for h in (0.02, 0.01)]
    assert errors[0] / errors[1] == pytest.approx(4.0, rel=0.05)


def table(A=0.01, w=40.0, e=0.5, g=9.81):
    return Scene(
        LinearSystem(M=1.0, force=[-g]), q0=1.0, v0=0.0, t_span=(0.0, 1.0), p=[A, w],
        contacts=LinearContacts(G=1.0, restitution=e, motion=sine), period=2.0 * math.pi / w,
    )  # fmt: skip


def sine(t, q, v, p, out):
    out[0, 0] = p[0] * math.sin(p[1] * t)
    out[0, 1] = p[0] * p[1] * math.cos(p[1] * t)
    out[0, 2] = -p[0] * p[1] * p[1] * math.sin(p[1] * t)


@pytest.mark.parametrize(("method", "error"), [(EventDriven(), 1e-11), (Moreau(h=1e-5), 3e-2)])
def test_the_impact_map_of_a_ball_on_a_table_has_its_periodic_orbit_as_a_fixed_point(method, error):
    # Every period one impact: cos(phase) = pi g (1-e) / (A w^2 (1+e)), relative speed 2 pi g / (w (1+e))
    A, w, e, g = 0.02, 40.0, 0.5, 9.81
    phase = math.acos(math.pi * g * (1.0 - e) / (A * w * w * (1.0 + e)))
    x = np.array([phase, -2.0 * math.pi * g / w / (1.0 + e)])
    assert ImpactMap(table(A, w, e, g), method)(x) == pytest.approx(x, abs=error)


def test_a_motion_that_never_strikes_again_is_labelled_as_such():
    rising = Scene(
        LinearSystem(M=1.0), q0=1.0, v0=0.0, t_span=(0.0, 1.0), contacts=LinearContacts(1.0), period=1.0
    )
    P = ImpactMap(rising, EventDriven(), limit=3)
    with pytest.raises(NoReturn, match="no impact within 3 s") as info:
        P([0.5, 0.0 - 1.0])
    assert info.value.x.tolist() == [0.5, -1.0]
    assert isinstance(info.value, LcpStepError)


def test_starts_inside_of_the_obstacle_are_marked():
    scene = scenes.cam_follower(rpm=358.5)
    for method in (EventDriven(), Moreau(h=1e-3)):
        found = periods(scene, method, [[-0.1, 0.0], [0.1, 0.0]], 1)
        assert found.status.tolist() == [INSIDE, 0]


@pytest.mark.parametrize(
    ("change", "said"),
    [
        ({"n": 0}, "n: expected a positive integer"),
        ({"drop": 5}, "drop: expected 0 <= drop <= n = 2"),
        ({"phase": 1.0}, "phase"),
        ({"phase": -0.1}, "phase"),
        ({"starts": [[0.0, 0.0, 0.0]]}, "starts: expected states"),
        ({"starts": [[math.nan, 0.0]]}, "starts: expected finite"),
        ({"starts": iter([[0.0, 0.0]])}, "starts: expected real numbers"),
        ({"starts": [["0.0", "0.0"]]}, "starts: expected real numbers"),
        ({"starts": []}, "starts: expected a matrix"),
        ({"scene": scenes.bouncing_ball()}, "has no period"),
    ],
)
def test_wrong_questions_are_named(change, said):
    given = {"scene": scenes.cam_follower(), "method": EventDriven(), "starts": [0.4, 0.4], "n": 2} | change
    with pytest.raises(ValueError, match=said):
        periods(**given)


def swing(t, q, v, p, out):
    out[0] = -p[0] * v[0] - math.sin(q[0]) + p[1] * math.cos(p[2] * t)


@pytest.mark.parametrize("phase", [0.0, 0.3])
def test_many_periods_of_a_pendulum_between_two_stops_are_those_one_after_another(phase):
    """Several periods in one run, each with its own impacts, and no further than to a target."""
    omega = 1.2
    scene = Scene(
        System(1, [[1.0]], swing), 0.1, 0.0, (0.0, 1.0), p=(0.3, 0.8, omega), period=2.0 * math.pi / omega,
        contacts=LinearContacts([[1.0], [-1.0]], [0.5, 0.5], restitution=0.6),
    )  # fmt: skip
    starts = np.array([[0.1, 0.0], [-0.3, 0.5]])
    many = periods(scene, EventDriven(), starts, 20, drop=3, phase=phase)
    x = starts
    for k in range(20):
        one = periods(scene, EventDriven(), x, 1, phase=phase)
        x = one.final
        if k >= 3:
            np.testing.assert_allclose(many.states[:, k - 3], x, atol=1e-10)
            np.testing.assert_array_equal(many.impacts[:, k - 3], one.impacts[:, 0])
            np.testing.assert_allclose(many.time[:, k - 3], one.time[:, 0], atol=1e-10)
            np.testing.assert_allclose(many.before[:, k - 3], one.before[:, 0], atol=1e-10)
    assert many.impacts.sum() > 40
    there = Targets(many.states[0, 7:8], np.array([1e-6]), np.ones(2))
    found = periods(scene, EventDriven(), starts[:1], 20, drop=20, phase=phase, targets=there)
    first = 1 + np.flatnonzero(np.max(np.abs(many.states[0] - there.points[0]), axis=1) <= 1e-6)[0] + 3
    assert (found.reached[0], found.taken[0]) == (0, first)


def breaking(t, q, v, p, out):
    if q[0] > 0.3:
        raise RuntimeError("broken")
    out[0] = 20.0 * math.sin(6.0 * t) - 9.81


SPRING = Scene(
    System(1, 1.0, breaking), 0.1, 0.0, (0.0, 1.0), LinearContacts(1.0, restitution=0.5), period=math.pi / 3.0
)
BROKEN = r"NOT_FINITE, system.force: .* failed at .*RuntimeError: broken"


@pytest.mark.parametrize("method", [EventDriven(), Moreau(1e-3)], ids=str)
def test_an_image_that_is_not_reached_says_what_a_callback_has_raised(method):
    with pytest.raises(LcpStepError, match=BROKEN):
        iterate(StroboscopicMap(SPRING, method), [0.1, 0.0], 20)


def test_attractors_that_no_run_comes_to_say_what_a_callback_has_raised():
    with pytest.warns(NoneSettled, match=BROKEN):
        found = attractors(SPRING, Moreau(1e-3), [[0.1, 0.0], [0.2, 0.0]], transient=20, window=4, longest=2)
    assert found.found == ()
    assert list(found.label) == [-1, -1]
