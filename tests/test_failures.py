"""What goes wrong during a run: named, with time and state, and without losing what was computed before."""

import math
import re
from dataclasses import replace
from importlib.metadata import metadata

import numpy as np
import pytest
import qpsolvers

from lagrangian import Contacts, LinearContacts, LinearJoints, LinearSystem, Scene, System, scenes
from lcpstep import (
    EventDriven,
    LcpStepError,
    Located,
    MissingSolver,
    Moreau,
    SimulationError,
    SimulationInterrupted,
    UnknownName,
    simulate,
)
from lcpstep.lcp.qp import known_solvers
from lcpstep.trajectory import Status

T_BAD = 0.3  # from here on callbacks go wrong


def bad_force(t, q, v, p, out):
    out[0] = -8.0 if t < 0.3 else math.nan


def infinite_force(t, q, v, p, out):
    out[0] = -8.0 if t < 0.3 else math.inf


def bad_mass(t, q, v, p, out):
    out[0, 0] = 1.0 if t < 0.3 else math.nan


def singular_mass(t, q, v, p, out):
    out[0, 0] = 1.0 if t < 0.3 else 0.0


def negative_mass(t, q, v, p, out):
    out[0, 0] = 1.0 if t < 0.3 else -1.0


def weight(t, q, v, p, out):
    out[0] = -8.0


def bad_frame(t, q, v, p, out):
    out[0, 0], out[0, 1], out[0, 2] = 0.0, 0.0, 0.0 if t < 0.3 else math.nan


def bad_motion(t, q, v, p, out):
    out[0, 0], out[0, 1], out[0, 2] = 0.0 if t < 0.3 else math.nan, 0.0, 0.0


def bad_motion_speed(t, q, v, p, out):
    out[0, 0], out[0, 1], out[0, 2] = 0.0, 0.0 if t < 0.3 else math.nan, 0.0


def gap(t, q, v, p, out):
    out[0] = q[0]


def bad_gap(t, q, v, p, out):
    out[0] = q[0] if t < 0.3 else math.nan


def jacobian(t, q, v, p, out):
    out[0, 0] = 1.0


def bad_jacobian(t, q, v, p, out):
    out[0, 0] = 1.0 if t < 0.3 else math.nan


def bad_gap_t(t, q, v, p, out):
    out[0] = 0.0 if t < 0.3 else math.nan


def bad_force_q(t, q, v, p, out):
    out[0, 0] = 0.0 if t < 0.3 else math.nan


def zero(t, q, v, p, out):
    out[0, 0] = 0.0


FLOOR = LinearContacts(G=1.0, restitution=0.5)
FALLING = LinearSystem(M=1.0, force=-8.0)
SPEED = LinearContacts(G=1.0, restitution=0.5, motion=bad_motion_speed)
CULPRITS = [
    ("system.force", LinearSystem(M=1.0, force=bad_force), FLOOR),
    ("system.force", LinearSystem(M=1.0, force=infinite_force), FLOOR),
    ("system.force", LinearSystem(M=1.0, force=bad_force), None),
    ("system.force", System(1, 1.0, bad_force), FLOOR),
    ("system.frame", LinearSystem(M=1.0, force=-8.0, frame=bad_frame), FLOOR),
    ("system.mass", System(1, bad_mass, weight), FLOOR),
    ("system.mass", System(1, singular_mass, weight), FLOOR),
    ("system.mass", System(1, negative_mass, weight), FLOOR),
    ("contacts.motion", FALLING, LinearContacts(G=1.0, restitution=0.5, motion=bad_motion)),
    ("contacts.motion", FALLING, SPEED),
    ("contacts.gap", FALLING, Contacts(1, bad_gap, jacobian)),
    ("contacts.jacobian", FALLING, Contacts(1, gap, bad_jacobian)),
    ("contacts.gap_t", FALLING, Contacts(1, gap, jacobian, gap_t=bad_gap_t)),
]
IDS = [
    "force", "infinite force", "force without contact", "force of a general system", "frame", "mass",
    "singular mass", "negative mass", "motion", "speed of the motion", "gap", "jacobian", "gap_t",
]  # fmt: skip
METHODS = [
    pytest.param(Moreau(1e-2), id="moreau"),
    pytest.param(Moreau(1e-2, theta=0.0), id="moreau, explicit"),
    pytest.param(EventDriven(), id="event-driven"),
    pytest.param(Located(1e-2), id="located"),
    pytest.param(Located(1e-2, order=4), id="order four"),
]


def run(system, contacts, method, q0=1.0):
    return simulate(Scene(system, q0, 0.0, (0.0, 1.0), contacts), method)


@pytest.mark.parametrize("method", METHODS)
@pytest.mark.parametrize(("name", "system", "contacts"), CULPRITS, ids=IDS)
def test_a_callback_that_goes_wrong_is_named_with_time_and_state(name, system, contacts, method):
    with pytest.raises(SimulationError, match=rf"{name}: .*t = 0\.\d+.*q = \[.*v = \[") as caught:
        run(system, contacts, method)
    m = caught.value.trajectory
    assert m.status is Status.NOT_FINITE
    assert str(caught.value) == m.message
    # up to a step before it (of Moreau 0.01 s, of the event-driven run a fiftieth of the span); what only a closed
    # contact asks for is noticed at the impact at 0.5 s, which Moreau predicts half a step early or late
    latest = 0.5 if name in ("contacts.jacobian", "contacts.gap_t") or contacts is SPEED else T_BAD
    assert 0.25 <= m.t[-1] <= latest + 2e-2
    assert np.all(np.isfinite(m.q))
    assert np.all(np.isfinite(m.v))
    # free fall, which the method knows exactly for theta = 1/2, and to order h for theta = 0
    np.testing.assert_allclose(m.q[:, 0], 1.0 - 4.0 * m.t**2, rtol=0, atol=4 * 1e-2 * latest + 1e-12)


def ends_without_a_gap(t, q, v, p, out):
    out[0] = q[0] if t < 1.0 - 1e-9 else math.nan


def upwards(t, q, v, p, out):
    out[0, 0] = 1.0


@pytest.mark.parametrize("method", [Moreau(0.1), Moreau(0.1, tolerance=1e-3), Located(0.1)], ids=repr)
def test_a_gap_that_is_no_number_in_the_last_step_is_told(method):
    contacts = Contacts(1, ends_without_a_gap, upwards)
    scene = Scene(LinearSystem(1.0), q0=1.0, v0=1.0, t_span=(0.0, 1.0), contacts=contacts)
    with pytest.raises(SimulationError, match="gap"):
        simulate(scene, method)


@pytest.mark.parametrize("method", METHODS)
def test_the_state_in_the_message_is_that_of_the_time_in_the_message(method):
    with pytest.raises(SimulationError) as caught:
        run(FALLING, LinearContacts(G=1.0, motion=bad_motion), method)
    m = caught.value.trajectory
    assert f"at t = {m.t[-1]:.9g} s, q = {m.q[-1].tolist()}, v = {m.v[-1].tolist()}" in m.message


@pytest.mark.parametrize("method", METHODS)
def test_a_jacobian_that_only_steers_is_named_too(method):
    if not isinstance(method, Moreau) or method.theta == 0.0:
        return  # it is not asked for
    with pytest.raises(SimulationError, match=r"system\.force_q: "):
        run(System(1, 1.0, weight, bad_force_q, zero), FLOOR, method)


@pytest.mark.parametrize("method", METHODS)
def test_a_callback_that_raises_in_plain_python_does_not_lose_the_motion(method):
    seen = []

    def breaks(t, q, v, p, out):
        seen.append(t)  # cannot be compiled
        if t > 0.3:
            raise RuntimeError("the spring broke")
        out[0] = -8.0

    with (
        pytest.warns(UserWarning, match="plain Python"),
        pytest.raises(SimulationError, match="spring broke") as caught,
    ):
        run(LinearSystem(M=1.0, force=breaks), FLOOR, method)
    assert 0.25 <= caught.value.trajectory.t[-1] <= 0.31


def breaks_compiled(t, q, v, p, out):
    if t > 0.3:
        raise ValueError("the spring broke")
    out[0] = -8.0


def forgets(t, q, v, p, out):
    out[0] = 0.0
    if t <= 0.3:
        out[1] = -8.0


@pytest.mark.filterwarnings("ignore::pytest.PytestUnraisableExceptionWarning")
@pytest.mark.parametrize("method", METHODS)
def test_a_compiled_callback_that_raises_is_not_passed_over(method):
    with pytest.raises(SimulationError, match="spring broke") as caught:
        run(System(1, 1.0, breaks_compiled), FLOOR, method)
    assert 0.25 <= caught.value.trajectory.t[-1] <= 0.31


@pytest.mark.parametrize("method", METHODS)
def test_an_entry_that_a_callback_leaves_out_later_is_noticed(method):
    scene = Scene(System(2, np.eye(2), forgets), [0.0, 1.0], [0.0, 0.0], (0.0, 1.0))
    with pytest.raises(SimulationError, match=r"system\.force: .*not filled"):
        simulate(scene, method)


def root_of_time(t, q, v, p, out):
    out[0] = -8.0 * math.sqrt(0.3 - t)


@pytest.mark.parametrize("method", METHODS)
def test_a_function_outside_of_its_domain_is_named(method):
    with pytest.raises(SimulationError, match=r"system\.force: "):
        run(LinearSystem(M=1.0, force=root_of_time), FLOOR, method)


def drifting_apart(t, q, v, p, out):
    """Two joints that agree at t = 0 up to the second derivative."""
    out[0, 0], out[0, 1], out[0, 2] = math.sin(t) - t, math.cos(t) - 1.0, -math.sin(t)
    out[1, 0], out[1, 1], out[1, 2] = 0.0, 0.0, 0.0


@pytest.mark.parametrize("method", [Moreau(1e-2), EventDriven()])
def test_joints_that_come_to_contradict_each_other_end_the_run(method):
    joints = LinearJoints([[1.0], [1.0]], motion=drifting_apart)
    m = simulate(Scene(LinearSystem(M=1.0), 0.0, 0.0, (0.0, 1.0), joints=joints), method)
    assert m.status is Status.JOINTS_FAILED
    assert "contradict" in m.message
    assert m.t[-1] < 0.1


# --- interrupts


class StopAt:
    """Progress callback that interrupts after a number of calls."""

    def __init__(self, calls):
        self.left, self.times = calls, []

    def __call__(self, t):
        self.times.append(t)
        self.left -= 1
        if self.left <= 0:
            raise KeyboardInterrupt


@pytest.mark.parametrize(
    ("scene", "method"),
    [
        (scenes.impact_oscillator(t_end=100.0), Moreau(1e-4)),
        (scenes.bouncing_ball(restitution=1.0, t_end=1e5), EventDriven()),
        (scenes.impact_oscillator(t_end=1e5), EventDriven()),
    ],
)
@pytest.mark.parametrize("keep", [1, 100, "impacts"])
def test_an_interrupt_hands_over_the_motion_so_far(scene, method, keep):
    stop = StopAt(3)
    with pytest.raises(SimulationInterrupted) as caught:
        simulate(scene, method, keep=keep, progress=stop)
    assert isinstance(caught.value, KeyboardInterrupt)
    m = caught.value.trajectory
    assert m.status is Status.INTERRUPTED
    assert "interrupted" in m.message
    assert len(stop.times) == 3
    assert m.t[-1] == pytest.approx(stop.times[-1], rel=1e-12)
    assert 0.0 < m.t[-1] < scene.t_span[1]
    whole = simulate(scene, method, keep=[m.t[-1] / 2, float(m.t[-1])])
    np.testing.assert_allclose(m.q[-1], whole.q[-1], rtol=0, atol=1e-9)
    known = m.impacts.time <= m.t[-1]
    np.testing.assert_array_equal(m.impacts[known], whole.impacts[: np.count_nonzero(known)])


def test_progress_rises_to_the_end():
    for method in (Moreau(1e-5), EventDriven()):
        times = []
        simulate(scenes.impact_oscillator(t_end=5.0), method, progress=times.append)
        assert times == sorted(times)
        assert times[-1] == pytest.approx(5.0, rel=1e-12)


def test_an_error_of_the_progress_callback_is_not_swallowed():
    def broken(t):
        raise ZeroDivisionError

    with pytest.raises(ZeroDivisionError):
        simulate(scenes.bouncing_ball(), Moreau(1e-2), progress=broken)


# --- clumsy input


@pytest.mark.parametrize(
    ("name", "values"),
    [
        ("q0", {"q0": [True]}),
        ("q0", {"q0": [[True]]}),
        ("q0", {"q0": (np.True_,)}),
        ("v0", {"v0": [False]}),
        ("q0", {"q0": [1.0 + 2.0j]}),
        ("q0", {"q0": np.ma.masked_array([1.0], mask=[True])}),
        ("q0", {"q0": np.array(["1"], dtype=object)}),
        ("q0", {"q0": [10**400]}),
        ("t_span", {"t_span": (False, 1.0)}),
        ("t_span", {"t_span": (0.0, True)}),
        ("p", {"p": [1.0, True]}),
        ("corners", {"corners": [True]}),
    ],
)
def test_what_is_no_number_is_refused_by_name(name, values):
    given = {"q0": 1.0, "v0": 0.0, "t_span": (0.0, 1.0)} | values
    with pytest.raises(ValueError, match=rf"^{name}: expected real numbers, got "):
        Scene(FALLING, **given)


def test_what_stands_for_something_else_is_refused_by_name():
    scene = Scene(FALLING, 1.0, 0.0, (0.0, 1.0))
    for progress in (5, "a bar"):
        with pytest.raises(TypeError, match=r"^progress: expected a function of the time reached"):
            simulate(scene, Moreau(0.1), progress=progress)
    for keep in ([0.0, True], ["0.1", "0.2"], [0.1j], None, [[0.1, 0.2]]):
        with pytest.raises(ValueError, match=r"^keep: expected increasing times"):
            simulate(scene, Moreau(0.1), keep=keep)
    for parameters in (3, [1.0], "mass"):
        with pytest.raises(TypeError, match=r"^parameters: expected names and values"):
            replace(scene, parameters=parameters)
    for part in ("system", "contacts", "joints"):
        with pytest.raises(TypeError, match=rf"^{part}: expected a Linear"):
            replace(scene, **{part: {}})
    with pytest.raises(TypeError, match=r"^friction: expected a Coulomb"):
        LinearContacts(G=1.0, friction=0.3)
    with pytest.raises(TypeError, match=r"^projected: expected a bool"):
        Moreau(0.1, projected="no")


@pytest.mark.parametrize("q0", [np.array(1), np.array([1]), [1], np.float32(1.0), np.ma.masked_array([1.0])])
def test_numbers_of_any_kind_are_taken(q0):
    assert Scene(FALLING, q0, 0.0, (0.0, 1.0)).q0.tolist() == [1.0]


def test_a_truth_value_among_numbers_of_a_matrix_is_refused():
    with pytest.raises(ValueError, match=r"^M: expected real numbers"):
        LinearSystem(M=[[1.0, 0.0], [0.0, True]])
    with pytest.raises(ValueError, match=r"^G: expected real numbers"):
        LinearContacts(G=[[True, 0.0]])


# --- methods and solvers


@pytest.mark.parametrize("h", [0.0, -1e-3, math.nan, math.inf, "small", None])
def test_the_step_is_positive(h):
    with pytest.raises(ValueError, match=r"^h: "):
        Moreau(h)


@pytest.mark.parametrize("method", [Moreau(1e-18), Located(1e-18)])
def test_a_step_below_the_resolution_of_time_is_refused(method):
    with pytest.raises(LcpStepError, match=r"h: steps of 1e-18 s are lost"):
        run(FALLING, FLOOR, method)


@pytest.mark.parametrize("method", [Moreau(1e-2), Located(1e-2), Located(1e-2, order=4)])
def test_a_step_longer_than_the_span_is_refused(method):
    scene = Scene(FALLING, 1.0, -1.0, (0.0, 9.9e-3), FLOOR)
    with pytest.raises(LcpStepError, match=r"^h: steps of 0\.01 s are longer than the span of 0\.0099 s"):
        simulate(scene, method)
    m = simulate(scene, replace(method, h=9.9e-3))
    assert m.counts.steps == 1
    assert m.t[-1] == 9.9e-3


def test_the_longest_step_of_a_tolerance_may_be_longer_than_the_span():
    m = simulate(Scene(FALLING, 1.0, -1.0, (0.0, 1e-13), FLOOR), Moreau(1e-2, tolerance=1e-6))
    assert m.t[-1] == 1e-13
    np.testing.assert_allclose(m.q[-1] - 1.0, -1e-13, rtol=1e-2)


@pytest.mark.parametrize("theta", [-0.1, 1.1, math.nan, "half", None])
def test_theta_lies_between_zero_and_one(theta):
    with pytest.raises(ValueError, match=r"^theta: "):
        Moreau(1e-3, theta)


@pytest.mark.parametrize(
    ("name", "near"),
    [("lemk", "lemke"), ("Lemke", "lemke"), ("qp:osqb", "qp:osqp"), ("qp:dqp", "qp:daqp"), ("osqp", "osqp")],
)
def test_an_unknown_solver_suggests_near_ones(name, near):
    with pytest.raises(UnknownName, match=f"unknown LCP solver '{name}'; did you mean .*{near}") as caught:
        Moreau(1e-3, lcp=name)
    assert isinstance(caught.value, ValueError)
    assert isinstance(caught.value, LcpStepError)


def test_a_solver_like_no_other_is_answered_with_all_of_them():
    with pytest.raises(UnknownName, match=r"known: .*lemke.*qp"):
        Moreau(1e-3, lcp="zzzzzz")


def test_a_solver_that_is_not_installed_is_answered_with_the_command_that_installs_it():
    missing = [n for n in known_solvers() if n not in qpsolvers.available_solvers]
    extras = set(metadata("qpsolvers").get_all("Provides-Extra"))
    assert missing
    for name in missing:
        with pytest.raises(MissingSolver, match=f"'{name}' is not installed: .*pip install") as caught:
            Moreau(1e-3, lcp=f"qp:{name}")
        assert isinstance(caught.value, ImportError)
        # a command that installs it: an extra of qpsolvers where there is one
        assert f"qpsolvers[{name}]" not in str(caught.value) or name in extras


def test_neither_scene_nor_method_may_be_something_else():
    with pytest.raises(TypeError, match=r"^scene: "):
        simulate("cam-follower", Moreau(1e-3))
    for method in (Moreau, EventDriven, "moreau", None):
        with pytest.raises(TypeError, match=r"^method: "):
            simulate(scenes.bouncing_ball(), method)


# --- statuses


def never_converges(t, q, v, p, out):
    # steep and bent: the velocity of the next step has no solution
    out[0] = 1e6 * q[0] ** 2 + 1e6


def test_a_step_that_does_not_converge_is_a_status_with_the_part_before():
    m = simulate(Scene(System(1, 1.0, never_converges), 1.0, 0.0, (0.0, 1.0)), Moreau(1e-2))
    assert m.status is Status.NEWTON_FAILED
    assert "smaller h" in m.message
    assert "t = 0" in m.message
    assert m.t[-1] < 1.0


@pytest.mark.parametrize("keep", [10**6, "impacts", [0.1], [0.9]], ids=str)
@pytest.mark.parametrize("method", METHODS)
def test_what_was_computed_before_a_failure_is_told_whatever_is_kept(method, keep):
    with pytest.raises(SimulationError) as caught:
        simulate(Scene(System(1, 1.0, bad_force), 1.0, 0.0, (0.0, 1.0), FLOOR), method, keep=keep)
    m = caught.value.trajectory
    t, q, v = (float(x) for x in re.findall(r"at t = (\S+) s, q = \[(\S+)\], v = \[(\S+)\]", m.message)[-1])
    assert 0.28 <= t <= 0.3 + 1e-9
    assert v == pytest.approx(-8.0 * t, abs=1e-9)
    assert q == pytest.approx(1.0 - 4.0 * t**2, abs=4.0 * 1e-2 * t)  # to order h for theta = 0
    if isinstance(keep, list):
        assert m.t.tolist() == [x for x in keep if x < t]
    else:
        assert m.t[-1] == pytest.approx(t, abs=1e-8)
        assert (m.q[-1, 0], m.v[-1, 0]) == (q, v)
