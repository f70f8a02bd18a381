"""Derivatives that are given wrong are named with both values; right, noisy, cornered, tabulated ones are not."""

import math
import re

import numpy as np
import pytest

from lagrangian import Contacts, Joints, LinearContacts, LinearSystem, Scene, System
from lagrangian.profiles import rotating_cam
from lagrangian.scenes.cam_follower import HALF_TURN, PROFILE
from lcpstep import EventDriven, Located, Moreau, SimulationError, Status, simulate

TWO = LinearSystem(M=np.eye(2))


def made(contacts=None, system=TWO, q0=(0.3, 1.0), v0=(0.5, -0.2), t_span=(0.0, 2.0), **others):
    return Scene(system, q0, v0, t_span, contacts, **others)


def bowl(sign=1.0, factor=1.0, bias_factor=1.0, rate=3.0, given=3.0):
    """A moving curved gap, x^2 - y^2/2 + 2 - sin(rate t), right with the defaults."""

    def gap(t, q, v, p, out):
        out[0] = q[0] ** 2 - 0.5 * q[1] ** 2 + 2.0 - math.sin(rate * t)

    def jacobian(t, q, v, p, out):
        out[0, 0], out[0, 1] = factor * 2.0 * q[0], -sign * q[1]

    def gap_t(t, q, v, p, out):
        out[0] = -given * math.cos(rate * t)

    def bias(t, q, v, p, out):
        out[0] = bias_factor * (2.0 * v[0] ** 2 - v[1] ** 2) + rate**2 * math.sin(rate * t)

    return Contacts(1, gap, jacobian, gap_t, bias)


@pytest.mark.parametrize("q0", [(0.3, 1.0), (0.0, 0.0), (0.0, 1.0), (-1.0, 0.0)])
@pytest.mark.parametrize("v0", [(0.5, -0.2), (0.0, 0.0)])
def test_right_derivatives_are_taken(q0, v0):
    made(bowl(), q0=q0, v0=v0)


@pytest.mark.parametrize("q0", [(0.3, 1.0), (0.0, 0.0)])
@pytest.mark.parametrize(
    ("wrong", "named"),
    [
        ({"sign": -1.0}, "contacts.jacobian[0, 1]"),
        ({"factor": 0.5}, "contacts.jacobian[0, 0]"),
        ({"factor": 180.0 / math.pi}, "contacts.jacobian[0, 0]"),
        ({"given": -3.0}, "contacts.gap_t[0]"),
        ({"given": 1.0}, "contacts.gap_t[0]"),
        ({"bias_factor": 2.0, "rate": 0.0, "given": 0.0}, "contacts.bias[0]"),
    ],
)
def test_a_wrong_sign_or_factor_is_named_with_both_values(wrong, named, q0):
    with pytest.raises(
        ValueError, match=rf"^{re.escape(named)} is .* near t = .* differences of .* give "
    ) as said:
        made(bowl(**wrong), q0=q0)
    given, found = (float(x) for x in re.findall(r"(?:is|give) (\S+?)(?= near|$)", str(said.value)))
    factor = next(iter(wrong.values())) / (3.0 if "given" in wrong and "rate" not in wrong else 1.0)
    assert given / found == pytest.approx(factor, rel=1e-2)


def test_a_gap_that_moves_without_its_rate_is_named():
    right = bowl()
    with pytest.raises(ValueError, match=r"^contacts\.gap_t \(not given\)\[0\] is 0 near .* give -"):
        made(Contacts(1, right.gap, right.jacobian))


def test_joints_are_compared_too():
    right, wrong = bowl(rate=0.0, given=0.0), bowl(sign=-1.0, rate=0.0, given=0.0)
    q0 = (0.0, 2.0)
    made(joints=Joints(1, right.gap, right.jacobian), q0=q0, v0=(1.0, 0.0))
    with pytest.raises(ValueError, match=r"^joints\.jacobian\[0, 1\] is "):
        made(joints=Joints(1, wrong.gap, wrong.jacobian), q0=q0, v0=(1.0, 0.0))


@pytest.mark.parametrize("column", [1, 2])
def test_wrong_derivatives_of_what_moves_are_named(column):
    def shaken(t, q, v, p, out):
        for i in range(len(out)):
            out[i, 0], out[i, 1], out[i, 2] = math.sin(5 * t), 5 * math.cos(5 * t), -25 * math.sin(5 * t)
            out[i, column] *= -1.0

    # either of the two that a wrong rate belongs to: it is no derivative, and has none
    with pytest.raises(ValueError, match=r"^contacts\.motion: out\[0, [12]\] is "):
        made(LinearContacts([[0.0, 1.0]], motion=shaken))
    with pytest.raises(ValueError, match=r"^system\.frame: out\[0, [12]\] is "):
        made(system=LinearSystem(M=np.eye(2), frame=shaken))


@pytest.mark.parametrize("wrong", ["force_q", "force_v"])
def test_wrong_derivatives_of_a_force_are_named(wrong):
    def force(t, q, v, p, out):
        out[0], out[1] = -4.0 * q[0] * q[1] - v[0] ** 3, -9.81 - 0.3 * v[1]

    def force_q(t, q, v, p, out):
        out[:] = 0.0
        out[0, 0], out[0, 1] = -4.0 * q[1], (4.0 if wrong == "force_q" else -4.0) * q[0]

    def force_v(t, q, v, p, out):
        out[:] = 0.0
        out[0, 0], out[1, 1] = (-1.0 if wrong == "force_v" else -3.0) * v[0] ** 2, -0.3

    with pytest.raises(ValueError, match=rf"^system\.{wrong}\[0, [01]\] is .* of system\.force\[0\] give "):
        made(system=System(2, np.eye(2), force, force_q, force_v))


def test_the_cam_is_right_at_its_corner_and_everywhere():
    p = PROFILE.pack(70.0, HALF_TURN)
    for t in (0.0, *np.linspace(0.0, 0.1, 23)):
        start = np.zeros((1, 3))
        rotating_cam(t, start[0], start[0], p, start)

        def cam(t, q, v, p, out):
            rotating_cam(t, q, v, p, out)

        Scene(LinearSystem(M=1.0), start[0, 0] + 0.1, 0.0, (t, t + 2.0), LinearContacts(1.0, motion=cam), p=p)


@pytest.mark.parametrize("entries", [50, 1000])
@pytest.mark.parametrize("noise", [0.0, 1e-6])
@pytest.mark.parametrize("nearest", [False, True])
def test_tables_are_taken(entries, noise, nearest):
    x = np.linspace(-4.0, 4.0, entries)
    f = 2.0 + np.cos(x) + noise * np.random.default_rng(1).normal(size=entries)
    slope = -np.sin(x)

    def look(table, at):
        return table[np.argmin(np.abs(x - at))] if nearest else np.interp(at, x, table)

    def gap(t, q, v, p, out):
        out[0] = look(f, q[0]) + q[1]

    def jacobian(t, q, v, p, out):
        out[0, 0], out[0, 1] = look(slope, q[0]), 1.0

    for start in np.linspace(-1.0, 1.0, 9):
        made(Contacts(1, lambda *a: gap(*a), lambda *a: jacobian(*a)), q0=(start, 1.0))


@pytest.mark.parametrize("q0", [0.0, 0.01, 1.0])
def test_corners_of_a_gap_and_what_lies_inside_of_it_are_taken(q0):
    def wedge(t, q, v, p, out):
        out[0], out[1] = abs(q[0]) + q[1], max(q[1], 0.0)

    def jacobian(t, q, v, p, out):
        out[0, 0], out[0, 1], out[1, 0], out[1, 1] = math.copysign(1.0, q[0]), 1.0, 0.0, 1.0

    made(Contacts(2, wedge, jacobian), q0=(q0, 0.0))


@pytest.mark.parametrize(
    "method", [Moreau(1e-2), Located(1e-2), EventDriven()], ids=["moreau", "located", "event"]
)
def test_a_derivative_that_is_wrong_later_is_found_by_the_run(method):
    def slope(t, q, v, p, out):
        out[0] = q[1] + (max(q[0] - 3.0, 0.0)) ** 2

    def jacobian(t, q, v, p, out):
        out[0, 0], out[0, 1] = -2.0 * max(q[0] - 3.0, 0.0), 1.0

    with pytest.raises(SimulationError, match=r"^contacts\.jacobian\[0, 0\] is .* give ") as caught:
        simulate(made(Contacts(1, slope, jacobian), q0=(0.0, 1.0), v0=(5.0, 0.0)), method)
    assert caught.value.trajectory.t[-1] == 2.0


@pytest.mark.parametrize("flat", [True, False])
@pytest.mark.parametrize("method", [Moreau(1e-3), EventDriven()], ids=["moreau", "event"])
def test_nothing_is_compared_beyond_the_span_where_a_table_ends(method, flat):
    t_of = np.linspace(0.0, 4.0, 17)
    s_of = 0.1 * np.sin(3.0 * t_of)
    speed = np.diff(s_of) / np.diff(t_of)  # the last one beyond the end too, where np.interp gives a constant

    def rate(t):
        return speed[min(int(np.searchsorted(t_of, t, side="right")) - 1, 15)]

    def motion(t, q, v, p, out):
        out[0, 0], out[0, 1], out[0, 2] = np.interp(t, t_of, s_of), rate(t), 0.0

    def gap(t, q, v, p, out):
        out[0] = q[0] - np.interp(t, t_of, s_of)

    def jacobian(t, q, v, p, out):
        out[0, 0] = 1.0

    def gap_t(t, q, v, p, out):
        out[0] = -rate(t)

    contacts = LinearContacts(1.0, motion=lambda *a: motion(*a))
    if not flat:
        contacts = Contacts(1, lambda *a: gap(*a), lambda *a: jacobian(*a), lambda *a: gap_t(*a))
    ball = LinearSystem(1.0, force=-9.81)
    made = Scene(ball, 0.3, 0.0, (0.0, 4.0), contacts, corners=t_of[1:-1])
    run = simulate(made, method)
    assert run.q[-1, 0] == pytest.approx(s_of[-1], abs=1e-3)


def many(n, wrong, calls):
    """So many coordinates, each above its own bowl."""

    def gap(t, q, v, p, out):
        for i in range(len(q)):
            out[i] = q[i] + 1.0 + 0.1 * q[i] ** 2

    def jacobian(t, q, v, p, out):
        out[:] = 0.0
        for i in range(len(q)):
            out[i, i] = 1.0 + (0.2 if i != wrong else 0.9) * q[i]

    def counted(*arguments):
        calls.append(None)
        jacobian(*arguments)

    contacts = Contacts(n, gap, counted if calls else jacobian)
    return Scene(
        LinearSystem(np.eye(n), force=-np.ones(n)), np.full(n, 0.5), np.zeros(n), (0.0, 0.1), contacts
    )


@pytest.mark.parametrize("n", [60, 70])
def test_wrong_derivatives_are_named_before_a_run_however_many_there_are(n):
    with pytest.raises(ValueError, match=r"^contacts\.jacobian\[41, 41\] is .* differences of .* give "):
        simulate(many(n, 41, []), Moreau(1e-2))
    assert simulate(many(n, None, []), Moreau(1e-2)).status == Status.DONE


def test_large_jacobians_are_not_filled_in_python_some_hundred_times():
    """A second and more went by, for 50 discs on a table a minute."""
    calls = [None]
    many(70, None, calls)
    assert len(calls) < 5


def test_what_has_been_looked_at_is_not_looked_at_again():
    calls = []
    right = bowl()

    def gap(t, q, v, p, out):
        calls.append(t)
        right.gap(t, q, v, p, out)

    contacts = Contacts(1, gap, right.jacobian, right.gap_t)
    made(contacts)
    first = len(calls)
    made(contacts, q0=(0.1, 0.2))
    assert len(calls) == first + 1


def test_what_is_right_with_the_first_parameters_is_looked_at_with_others():
    def gap(t, q, v, p, out):
        out[0] = 1.0 + p[0] * math.sin(q[0])

    def jacobian(t, q, v, p, out):  # the factor is forgotten
        out[0, 0] = math.cos(q[0])

    contacts, system = Contacts(1, gap, jacobian), LinearSystem(M=1.0)
    made(contacts, system, q0=0.3, v0=0.1, p=[1.0])
    with pytest.raises(ValueError, match=r"^contacts\.jacobian\[0, 0\] is "):
        made(contacts, system, q0=0.3, v0=0.1, p=[2.0])


def test_what_is_wrong_is_so_every_time():
    wrong = bowl(sign=-1.0)
    for _ in range(2):
        with pytest.raises(ValueError, match="differences of"):
            made(wrong)


@pytest.mark.parametrize(
    "method", [Moreau(1e-2), Located(1e-2), EventDriven()], ids=["moreau", "located", "event"]
)
def test_a_mass_matrix_that_is_not_symmetric_later_is_found_by_the_run(method):
    def mass(t, q, v, p, out):
        out[0, 0], out[0, 1], out[1, 0], out[1, 1] = 1.0, t, 0.0, 1.0

    def force(t, q, v, p, out):
        out[0], out[1] = 0.0, -9.81

    with pytest.raises(SimulationError, match=r"^system\.mass: the mass matrix must be symmetric") as caught:
        simulate(made(system=System(2, mass, force)), method)
    assert caught.value.trajectory.t[-1] == 2.0


def test_obstacles_and_frames_that_depend_on_the_state_and_gaps_on_velocities_are_named():
    def bumpy(t, q, v, p, out):  # the ground under a body, taken for an obstacle that moves by itself
        out[0, 0], out[0, 1], out[0, 2] = 0.1 * math.cos(q[0]), 0.0, 0.0

    def foreseen(t, q, v, p, out):
        out[0] = q[0] + 0.1 * v[0]

    def one(t, q, v, p, out):
        out[0, 0] = 1.0

    for said, make in (
        (
            r"contacts\.motion: expected a function of time alone",
            lambda: ball(LinearContacts(1.0, 2.0, motion=bumpy)),
        ),
        (r"contacts\.gap: expected a function of time and co", lambda: ball(Contacts(1, foreseen, one))),
        (r"joints\.gap: expected a function of time and co", lambda: ball(joints=Joints(1, foreseen, one))),
        (
            r"system\.frame: expected a function of time alone",
            lambda: ball(system=LinearSystem(1.0, frame=bumpy)),
        ),
    ):
        with pytest.raises(ValueError, match=said):
            make()


def ball(contacts=None, system=None, joints=None):
    return Scene(system or LinearSystem(M=1.0), 0.0, 0.0, (0.0, 1.0), contacts, joints)
