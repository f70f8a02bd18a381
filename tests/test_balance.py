"""Steps that lose or gain energy for which no force accounts are told; what has a source is not."""

import math
import re

import numpy as np
import pytest

from lagrangian import Contacts, LinearContacts, LinearSystem, Scene, System, scenes
from lcpstep import EventDriven, Located, Moreau, simulate
from lcpstep.trajectory import Status
from tests.uncompiled import both_ways

METHODS = (Located(1e-2), Located(1e-2, 4), Moreau(1e-2))


def wavy_mass(t, q, v, p, out):
    out[0, 0] = 1.0 + 0.5 * math.sin(p[0] * q[0])


def wavy_force(t, q, v, p, out):
    out[0] = p[1] - 0.25 * p[0] * math.cos(p[0] * q[0]) * v[0] * v[0]


def wavy(number, t_end, **given):
    """A body whose mass is 1 + sin(number q)/2, pulled with 5 N: (1 + sin(number q)/2) v^2/2 - 5 q is constant."""
    return Scene(System(1, wavy_mass, wavy_force), 0.0, 0.0, (0.0, t_end), p=(number, 5.0), **given)


def energy_of_wavy(m, number):
    q, v = m.q[:, 0], m.v[:, 0]
    return 0.5 * (1.0 + 0.5 * np.sin(number * q)) * v * v - 5.0 * q


@pytest.mark.parametrize("method", METHODS)
def test_what_is_lost_where_the_mass_turns_within_a_step_is_told(method):
    """At 60 rad/m and 5 m/s the mass turns by 3 rad in a step; at 1.5 rad/m hardly."""
    m = simulate(wavy(60.0, 1.0), method)
    assert m.status is Status.DONE
    assert "that no force accounts for" in m.doubt
    assert m.doubt in m.message
    lost = float(re.search(r"for, (\S+) J of", m.doubt)[1])
    E = energy_of_wavy(m, 60.0)
    assert lost == pytest.approx(abs(E[-1] - E[0]), rel=0.1)
    m = simulate(wavy(1.5, 1.5), method)
    assert m.doubt == ""
    assert np.ptp(energy_of_wavy(m, 1.5)) < 1e-2 * 5.0 * m.q[-1, 0]


def unit(n):
    return np.eye(n)


def spring(t, q, v, p, out):
    out[0] = -p[0] * q[0] - p[1] * v[0] + p[2]


def floor(s=0.0, omega=0.0, e=0.8):
    def gap(t, q, v, p, out):
        out[0] = q[0] - s * math.sin(omega * t)

    def jacobian(t, q, v, p, out):
        out[0, 0] = 1.0

    def rate(t, q, v, p, out):
        out[0] = -s * omega * math.cos(omega * t)

    def curvature(t, q, v, p, out):
        out[0] = s * omega * omega * math.sin(omega * t)

    return Contacts(1, gap, jacobian, gap_t=rate if s else None, bias=curvature, restitution=e)


EXPLAINED = {
    "an oscillator, near the bound of Verlet": ((1e4, 0.0, 0.0), 0.1, 0.0, None),
    "damping": ((0.0, 30.0, -9.81), 1.0, 0.0, None),
    "a ball that bounces": ((0.0, 0.0, -9.81), 1.0, 0.0, floor()),
    "a ball that rests": ((0.0, 0.0, -9.81), 0.0, 0.0, floor()),
    "a force that starts at zero": ((0.0, 0.0, 0.0), 0.0, 0.0, floor()),
    "a table that shakes": ((0.0, 0.0, -9.81), 0.0, 0.5, floor(0.05, 5.0, 0.0)),
}


@pytest.mark.parametrize("method", METHODS)
@pytest.mark.parametrize("name", EXPLAINED)
def test_what_has_a_source_is_no_doubt(name, method):
    p, q0, v0, contacts = EXPLAINED[name]
    m = simulate(Scene(System(1, unit(1), spring), q0, v0, (0.0, 5.0), contacts, p=p), method)
    assert (m.status, m.doubt) == (Status.DONE, "")


@pytest.mark.parametrize(
    "name", ["an oscillator, near the bound of Verlet", "damping", "a ball that bounces"]
)
@pytest.mark.parametrize("method", METHODS)
def test_what_has_a_source_is_no_doubt_of_a_linear_system(name, method):
    (k, c, f), q0, v0, contacts = EXPLAINED[name]
    m = simulate(Scene(LinearSystem(1.0, C=c, K=k, force=[f]), q0, v0, (0.0, 5.0), contacts), method)
    assert (m.status, m.doubt) == (Status.DONE, "")


@pytest.mark.parametrize(("damping", "told"), [(2.0, False), (3.0, True)])
def test_damping_that_explicit_steps_make_grow_is_told(damping, told):
    """Order four takes c h from v to R v, R = 1 - c h + (c h)^2/2 - (c h)^3/6 + (c h)^4/24: 1.4 where c h = 3."""
    scene = Scene(
        LinearSystem(np.eye(2), C=np.diag([0.0, 10.0 * damping]), K=np.eye(2)),
        [1.0, 0.3],
        [0.0, 0.5],
        (0.0, 3.0),
    )
    true = simulate(scene, EventDriven())
    m = simulate(scene, Located(0.1, 4))
    assert (m.status, "gain energy that no force accounts for" in m.doubt) == (Status.DONE, told)
    assert bool(np.max(np.abs(m.q[-1] - true.q[-1])) > 100.0) is told
    assert simulate(scene, Located(0.1, 2)).doubt == ""  # the trapezoidal rule


@pytest.mark.parametrize("method", METHODS)
def test_a_wall_that_takes_energy_is_no_doubt(method):
    """What impacts dissipate, e = 0.3, the steps have not lost."""
    wall = LinearContacts([[-1.0]], 1.0, restitution=0.3)
    m = simulate(wavy(1.5, 4.0, contacts=wall), method)
    assert (m.status, m.doubt) == (Status.DONE, "")


@pytest.mark.parametrize(
    "keep", [3, "impacts", np.linspace(0.0, 4.0, 50)], ids=["every third", "impacts", "times"]
)
def test_states_that_are_no_step_apart_say_nothing(keep):
    assert simulate(wavy(60.0, 4.0), Located(1e-2), keep=keep).doubt == ""


def test_the_shortest_spans_have_a_balance():
    m = simulate(Scene(LinearSystem(1.0, force=-9.81), 1.0, 0.0, (0.0, 1e-300)), Located(1e-302, 4))
    assert m.doubt == ""
    assert m.v[-1, 0] == pytest.approx(-9.81e-300)


@pytest.mark.parametrize("order", [2, 4])
def test_a_pendulum_is_balanced(order):
    assert simulate(scenes.pendulum_stop(), Located(1e-2, order)).doubt == ""


PROGRAM = """
import numpy as np
from lcpstep import Located, simulate
from lcpstep.kernels.surplus import surplus
from lcpstep.model import model
from lagrangian import Scene, System

def mass(t, q, v, p, out):
    out[0, 0], out[0, 1], out[1, 0], out[1, 1] = 2.0 + np.sin(9.0 * q[0]), 0.1, 0.1, 1.0

def force(t, q, v, p, out):
    out[0], out[1] = 5.0 - 4.5 * np.cos(9.0 * q[0]) * v[0] * v[0], -3.0 * q[1]

m = simulate(Scene(System(2, mass, force), [0.0, 0.3], [0.0, 0.1], (0.0, 0.6)), Located(0.05))
both = np.column_stack([np.arange(12), np.arange(1, 13)]).ravel()
print(*(float(x).hex() for x in surplus(model(m.scene), m.t[both], m.q[both], m.v[both], 5e-5, False)))
"""


@pytest.mark.slow
def test_the_balance_of_the_sources_alone_is_that_of_what_is_built():
    built, plain = both_ways(PROGRAM)
    assert built == plain


def attraction(t, q, v, p, out):
    out[0] = -1.0 / (q[0] * q[0])


@pytest.mark.parametrize("method", [Located(1e-3), Located(1e-3, 4), Moreau(1e-3)])
def test_a_step_through_a_centre_of_attraction_is_told(method):
    """From rest at q = 1 the centre is met at pi / sqrt(8); a step in ten thousand gives or takes all energy."""
    m = simulate(Scene(System(1, [[1.0]], attraction), 1.0, 0.0, (0.0, 10.0)), method)
    E = 0.5 * m.v[:, 0] ** 2 - 1.0 / np.abs(m.q[:, 0])
    assert abs(E[-1] + 1.0) > 100.0
    assert "energy that no force accounts for" in m.doubt
    before = simulate(Scene(System(1, [[1.0]], attraction), 1.0, 0.0, (0.0, 1.1)), method)
    assert before.doubt == ""


@pytest.mark.parametrize(
    ("wall", "method", "told"),
    [
        (0.1, Located(2e-3), False), (0.1, Located(1e-3, 4), False), (0.1, Moreau(1e-3), False),
        (1e-3, Located(1e-2), True), (1e-3, Located(1e-3), True), (1e-3, Located(1e-3, 4), True),
        (1e-3, Moreau(1e-3), True),
    ],
)  # fmt: skip
def test_a_wall_before_a_centre_of_attraction_is_told(wall, method, told):
    """An elastic wall at 0.1, where a step changes the force by a part of it, or at 1e-3, where it is too long."""
    contacts = LinearContacts([[1.0]], [-wall], restitution=1.0)
    m = simulate(Scene(System(1, [[1.0]], attraction), 1.0, 0.0, (0.0, 6.0), contacts=contacts), method)
    E = 0.5 * m.v[:, 0] ** 2 - 1.0 / m.q[:, 0]
    assert m.status is Status.DONE
    assert (np.max(np.abs(E + 1.0)) > 100.0, "energy that no force accounts for" in m.doubt) == (told, told)


@pytest.mark.parametrize("times", [[0.3], np.linspace(0.0, 0.5, 50)], ids=["few", "many"])
def test_states_asked_for_that_end_before_the_impacts_do(times):
    """Was an IndexError."""
    wall = LinearContacts([[-1.0]], 0.6, restitution=0.5)
    scene = Scene(LinearSystem(1.0, K=1.0), 0.0, 1.0, (0.0, 2.0), contacts=wall)
    for h in (1e-2, times[1] - times[0] if len(times) > 1 else 0.3):
        m = simulate(scene, Located(h, 4), keep=times)
        assert m.impacts.time[0] > times[-1]
        assert (m.status, m.doubt) == (Status.DONE, "")


def pushed(t, q, v, p, out):
    """100 N for 10 ms."""
    out[0] = 100.0 if 2.345 <= t < 2.355 else 0.0


def one(t, q, v, p, out):
    out[0, 0] = 1.0


@pytest.mark.parametrize("period", [math.inf, 2.5])
@pytest.mark.parametrize("method", [Located(1.0 / 60.0), Located(1.0 / 60.0, 4)])
def test_steps_that_stop_at_a_corner_are_not_said_to_gain_what_a_push_gives(method, period):
    scene = Scene(System(1, one, pushed), 0.0, 0.0, (0.0, 5.0), corners=[2.345, 2.355], period=period)
    m = simulate(scene, method)
    assert (m.q[-1, 0], m.v[-1, 0]) == pytest.approx((2.65, 1.0), abs=1e-12)
    assert m.doubt == ""
    assert m.at(2.35)[0][0] == pytest.approx(0.5 * 100.0 * 0.005**2, abs=1e-12)
    times = np.linspace(2.345, 2.367, 2001)
    true = np.where(times < 2.355, 50.0 * (times - 2.345) ** 2, times - 2.35)
    # Of order 2 within the step, which bends at the corner
    error = np.max(np.abs(m.at(times)[0][:, 0] - true))
    bar = simulate(scene, method, error=True).error.position.sup
    assert error < 1e-13 or 0.5 < error / bar < 2.0


@pytest.mark.parametrize("order", [2, 4])
def test_corners_are_known_where_states_are_kept_late(order):
    def pushes(t, q, v, p, out):
        out[0] = 100.0 if 0.0345 <= t % 0.05 < 0.0355 else 0.0

    h = 1.0 / 60.0
    scene = Scene(System(1, one, pushes), 0.0, 0.0, (0.0, 5.0), corners=[0.0345, 0.0355], period=0.05)
    assert simulate(scene, Located(h, order), keep=np.arange(280, 300) * h).doubt == ""


def lifted(t, q, v, p, out):
    """Presses with 2 N, then lifts with 10 N."""
    out[0] = 10.0 if t >= 0.3575 else -2.0


@pytest.mark.parametrize("order", [2, 4])
def test_what_is_lifted_off_its_floor_at_a_corner_gains_what_the_force_gives(order):
    """Forces at both ends of the step in which it leaves tell nothing: it lay still up to the corner."""
    ground = LinearContacts(1.0, 0.0)
    scene = Scene(System(1, unit(1), lifted), 0.0, 0.0, (0.0, 0.36), ground, corners=[0.3575])
    m = simulate(scene, Located(2e-3, order))
    assert m.v[-1, 0] == pytest.approx(10.0 * 0.0025, abs=1e-12)
    assert m.doubt == ""


def pulls(t, q, v, p, out):
    out[0] = -10.0 + p[0] * math.sin(p[1] * t)


def test_what_steps_gain_on_a_floor_is_told_beside_the_energy_of_the_whole_run():
    """Moreau's press back what opens already, by energies of order h^2: here a millionth of that of the fall."""
    ground, p = LinearContacts(1.0, 0.0, 0.5), (10.831284939745217, 11.1)
    assert (
        simulate(Scene(System(1, unit(1), pulls), 1.0, 0.0, (0.0, 3.0), ground, p=p), Moreau(5e-4)).doubt
        == ""
    )
