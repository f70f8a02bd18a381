"""Belts and obstacles whose velocity jumps at a time that `corners` do not name, beside closed forms.

The motion put back onto what holds it had been dragged along, by up to all of the jump, and the run said DONE.
"""

import numpy as np
import pytest

from lagrangian import Coulomb, LinearContacts, LinearJoints, LinearSystem, Scene
from lcpstep import EventDriven, Located, Moreau, Status, simulate

G, MU, END = 9.81, 0.25, 1.0
TIMES = [1.0 / 3.0, 0.5123456]
METHODS = [(EventDriven(1e-10, 1e-10), 1e-9), (Moreau(1e-2, tolerance=1e-5), 1e-7)]  # and how near each comes


def moves(t, q, v, p, out):
    """Obstacle c has the velocity p[1 + c] from t = p[0] on."""
    late = t >= p[0]
    for c in range(out.shape[0]):
        out[c, 0] = p[1 + c] * (t - p[0]) if late else 0.0
        out[c, 1] = p[1 + c] if late else 0.0
        out[c, 2] = 0.0


def along(t, q, v, p, out):
    out[0, 0], out[0, 1] = 1.0, 0.0


def runs(t, q, v, p, out):
    """The belt has the velocity p[1], and p[2] from t = p[0] on."""
    out[0] = -p[2] if t >= p[0] else -p[1]


def ends_at(scene, q, v, method=None, within=1e-9):
    run = simulate(scene, method or EventDriven(1e-10, 1e-10))
    assert run.status is Status.DONE
    np.testing.assert_allclose(run.q[-1], q, rtol=0, atol=within)
    np.testing.assert_allclose(run.v[-1], v, rtol=0, atol=within)


def after(speed, belt, rest):
    """Way and velocity a time `rest` after a belt, on which a block has this speed, has taken another."""
    sign = 1.0 if belt > speed else -1.0
    until = min(rest, abs(belt - speed) / (MU * G))
    way = speed * until + 0.5 * sign * MU * G * until**2
    v = belt if until < rest else speed + sign * MU * G * until
    return way + v * (rest - until), v


@pytest.mark.parametrize(("method", "within"), METHODS)
@pytest.mark.parametrize("time", TIMES)
@pytest.mark.parametrize(("first", "then"), [(0.6, -0.4), (0.6, 0.0), (0.0, 1.9), (0.3, 0.35)])
def test_a_belt_that_jumps_lets_slip_what_sticks_to_it(time, first, then, method, within):
    belt = LinearContacts([[0.0, 1.0]], restitution=0.5, friction=Coulomb(MU, along, runs))
    block = LinearSystem(np.eye(2), force=[0.0, -G])
    scene = Scene(block, [0.0, 0.0], [first, 0.0], (0.0, END), belt, p=[time, first, then])
    way, v = after(first, then, END - time)
    ends_at(scene, [first * time + way, 0.0], [v, 0.0], method, within)


@pytest.mark.parametrize("time", TIMES)
@pytest.mark.parametrize("then", [0.9, 3.0])
def test_and_turns_the_friction_of_what_slides_on_it(time, then):
    """A block slides at 2 m/s on a belt at rest, which then runs more slowly, or faster than it."""
    belt = LinearContacts([[0.0, 1.0]], friction=Coulomb(MU, along, runs))
    block = LinearSystem(np.eye(2), force=[0.0, -G])
    scene = Scene(block, [0.0, 0.0], [2.0, 0.0], (0.0, END), belt, p=[time, 0.0, then])
    way, v = after(2.0, 0.0, time)
    more, v = after(v, then, END - time)
    ends_at(scene, [way + more, 0.0], [v, 0.0])


@pytest.mark.parametrize(("method", "within"), METHODS)
@pytest.mark.parametrize("time", TIMES)
@pytest.mark.parametrize("speed", [0.4, -1.5])
@pytest.mark.parametrize("kind", ["smooth", "rough", "joint"])
def test_a_table_takes_along_what_lies_on_it_or_drops_from_under_it(time, speed, kind, method, within):
    friction = Coulomb(MU, [[1.0, 0.0]]) if kind == "rough" else None
    table = LinearContacts([[0.0, 1.0]], restitution=0.5, motion=moves, friction=friction)
    joint = LinearJoints([[1.0, 0.0]]) if kind == "joint" else None
    scene = Scene(
        LinearSystem(np.diag([1.0, 2.0]), force=[0.0, -2.0 * G]), [0.0, 0.0], [0.0, 0.0],
        (0.0, END if speed > 0.0 else time + 0.25), table, joint, p=[time, speed],
    )  # fmt: skip
    rest = scene.t_span[1] - time
    if speed > 0.0:
        ends_at(scene, [0.0, speed * rest], [0.0, speed], method, within)
    else:
        ends_at(scene, [0.0, -0.5 * G * rest**2], [0.0, -G * rest], method, within)


@pytest.mark.parametrize("rough", [False, True])
def test_one_of_three_walls_of_which_two_would_hold_throws_a_particle_out(rough):
    """Its row depends on those held, which is why no force belongs to it; nothing else acts from then on."""
    walls = np.array([[1.0, 0.0], [0.0, 1.0], [0.6, 0.8]])
    friction = Coulomb(0.0, walls[:, ::-1] * [-1.0, 1.0]) if rough else None
    out = LinearContacts(walls, motion=moves, friction=friction)
    scene = Scene(LinearSystem(np.eye(2)), [0.0, 0.0], [0.0, 0.0], (0.0, END), out, p=[0.3, 0.0, 0.0, 0.5])
    ends_at(scene, [0.3 * 0.7, 0.4 * 0.7], [0.3, 0.4])


def leaves(t, q, v, p, out):
    """The table is at rest at time zero, and has the velocity p[0] after it."""
    out[0, 0], out[0, 1], out[0, 2] = p[0] * t, p[0] if t > 0.0 else 0.0, 0.0


@pytest.mark.parametrize("rough", [False, True])
@pytest.mark.parametrize("method", [EventDriven(), Located(1e-2, 4), Located(1e-2, tolerance=1e-6)])
def test_a_table_that_drops_at_the_very_start_lets_go_what_lies_on_it(method, rough):
    """Halving had no end at time zero, below which there is always half of it."""
    friction = Coulomb(MU, [[1.0, 0.0]]) if rough else None
    table = LinearContacts([[0.0, 1.0]], 0.0, 0.5, motion=leaves, friction=friction)
    block = LinearSystem(np.eye(2), force=[0.0, -G])
    scene = Scene(block, [0.0, 0.0], [0.0, 0.0], (0.0, 0.5), table, p=[-4.5])
    ends_at(scene, [0.0, -0.125 * G], [0.0, -0.5 * G], method)


def jolts(t, q, v, p, out):
    """The table has the velocity p[1] for a while of p[2] from t = p[0] on, less than a step."""
    out[0, 0] = p[1] * min(max(t - p[0], 0.0), p[2])
    out[0, 1] = p[1] if p[0] <= t < p[0] + p[2] else 0.0
    out[0, 2] = 0.0


@pytest.mark.parametrize("rough", [False, True])
def test_a_table_that_stops_before_the_step_ends_throws_up_what_lies_on_it(rough):
    """Its velocity is nothing where the step begins and where it ends: it is its place that tells."""
    friction = Coulomb(MU, [[1.0, 0.0]]) if rough else None
    table = LinearContacts([[0.0, 1.0]], motion=jolts, friction=friction)
    block = LinearSystem(np.eye(2), force=[0.0, -G])
    scene = Scene(block, [0.0, 0.0], [0.0, 0.0], (0.0, 0.42), table, p=[1.0 / 3.0, 0.9, 0.0025])
    rest = 0.42 - 1.0 / 3.0 - 0.0025
    ends_at(scene, [0.0, 0.9 * 0.0025 + 0.9 * rest - 0.5 * G * rest**2], [0.0, 0.9 - G * rest])


STEPS = [Located(1e-2), Located(1e-2, order=4), Located(1e-2, tolerance=1e-6)]


@pytest.mark.parametrize("method", STEPS, ids=["order 2", "order 4", "tolerance"])
@pytest.mark.parametrize("v", [0.0, 2.0])
@pytest.mark.parametrize("then", [-0.4, 3.0])
def test_steps_with_friction_find_the_time_too(method, v, then):
    """At rest on the belt, or faster than it: it had been dragged along, or had stopped where it is turned."""
    belt = LinearContacts([[0.0, 1.0]], restitution=0.5, friction=Coulomb(MU, along, runs))
    block = LinearSystem(np.eye(2), force=[0.0, -G])
    scene = Scene(block, [0.0, 0.0], [v, 0.0], (0.0, END), belt, p=[0.5123456, 0.0, then])
    way, v = after(v, 0.0, 0.5123456)
    more, v = after(v, then, END - 0.5123456)
    ends_at(scene, [way + more, 0.0], [v, 0.0], method, 1e-6)


@pytest.mark.parametrize("method", STEPS, ids=["order 2", "order 4", "tolerance"])
def test_and_drop_a_rough_table(method):
    table = LinearContacts([[0.0, 1.0]], 0.0, 0.5, motion=moves, friction=Coulomb(MU, [[1.0, 0.0]]))
    block = LinearSystem(np.eye(2), force=[0.0, -G])
    scene = Scene(block, [0.0, 0.0], [0.0, 0.0], (0.0, 0.7), table, p=[0.5123456, -1.5])
    rest = 0.7 - 0.5123456
    ends_at(scene, [0.0, -0.5 * G * rest**2], [0.0, -G * rest], method, 1e-6)
