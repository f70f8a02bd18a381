"""How fast errors of steps with friction fall: with the step as its order says, by a tolerance with the tolerance."""

import math
from dataclasses import replace

import numpy as np
import pytest

from lagrangian import (
    Contacts,
    Coulomb,
    Harmonic,
    Joints,
    LinearContacts,
    LinearSystem,
    Scene,
    System,
    scenes,
)
from lcpstep import EventDriven, Kind, Located, Status, simulate
from tests.events.rough import G0, block, rod, rod_row, shaken_tangent, times, weight

ORDERS = (2, 4)
SPREAD = (1.0, 1.07, 1.13, 1.21)


def shaken_floor(t, q, v, p, out):
    out[0] = -0.4 * math.cos(7.0 * t)


def driven(slope, **contact):
    """A body on a spring above a rough floor, thrown onto it, and driven along and away from it."""
    return Scene(
        system=LinearSystem(
            np.eye(2), C=np.diag([0.3, 0.0]), K=np.diag([30.0, 0.0]),
            force=Harmonic(constant=[0.0, -G0], sine=slope, omega=5.0),
        ),
        contacts=LinearContacts([[0.0, 1.0]], **contact),
        q0=[0.2, 0.3], v0=[1.5, 0.0], t_span=(0.0, 4.0),
    )  # fmt: skip


def on_a_shaken_floor():
    """It bounces to rest, slides both ways and sticks."""
    friction = Coulomb(0.3, shaken_tangent, slip=shaken_floor)
    return driven([4.0, 8.0], restitution=0.5, friction=friction)


def torn_off():
    """It lands without rebound, sticks, slips and is torn off, three times."""
    return driven([6.0, 12.0], friction=Coulomb(0.5, [[1.0, 0.0]]))


def pendulum():
    """It drags along a wall that it strikes."""
    return Scene(
        system=System(2, np.eye(2), weight), joints=Joints(1, rod, rod_row),
        contacts=LinearContacts([[1.0, 0.0]], restitution=0.4, friction=Coulomb(0.3, [[0.0, 1.0]])),
        q0=[math.sin(1.0), -math.cos(1.0)], v0=[0.0, 0.0], t_span=(0.0, 2.0),
    )  # fmt: skip


def falling_coefficient(t, q, u, p, out):
    out[0] = 0.2 + 0.3 * math.exp(-abs(u[0]) / 0.3)


def weakening():
    """Bounces, sticks, slips and turns about with a coefficient that falls as it slides faster."""
    return driven([4.0, 8.0], restitution=0.5, friction=Coulomb(falling_coefficient, [[1.0, 0.0]]))


def clinging():
    """The same with more friction where it sticks."""
    return driven([4.0, 8.0], restitution=0.5, friction=Coulomb(0.3, [[1.0, 0.0]], mu_s=0.45))


def fitted_order(scene, order, levels):
    """Slope of log(mean error) over log(h); errors are those of q at twenty times."""
    t = np.linspace(*scene.t_span, 21)[1:]
    q, _ = simulate(scene, EventDriven(1e-13, 1e-13)).at(t)
    errors = []
    for n in levels:
        steps = [scene.t_span[1] / round(n * s) for s in SPREAD]
        runs = [simulate(scene, Located(h, order=order), keep=t) for h in steps]
        errors.append(np.mean([np.max(np.abs(run.q - q)) for run in runs]))
    return -np.polyfit(np.log(levels), np.log(errors), 1)[0]


# --- orders


LEVELS = {2: (30, 300, 3000, 30000), 4: (30, 100, 300, 1000)}


@pytest.mark.parametrize("order", ORDERS)
@pytest.mark.parametrize("make", [on_a_shaken_floor, torn_off, pendulum, clinging, lambda: block(21)])
def test_impacts_reversals_sticking_and_release_cost_no_order(make, order):
    assert fitted_order(make(), order, LEVELS[order]) > {2: 1.9, 4: 3.8}[order]


@pytest.mark.parametrize(
    ("order", "levels"),
    [pytest.param(2, (300, 3000, 30_000, 300_000), marks=pytest.mark.slow), (4, (100, 300, 1000, 3000))],
)
def test_a_coefficient_that_depends_on_the_sliding_velocity_costs_none_either(order, levels):
    assert fitted_order(weakening(), order, levels) > {2: 1.9, 4: 3.8}[order]


def test_these_scenes_have_every_kind_of_event():
    seen = {
        int(k) for make in (on_a_shaken_floor, torn_off) for k in simulate(make(), Located(1e-2)).impacts.kind
    }
    assert seen == {int(kind) for kind in Kind if kind <= Kind.REVERSE}


@pytest.mark.slow
@pytest.mark.parametrize(("order", "levels"), [(2, (1000, 10_000, 100_000)), (4, (1000, 3000, 10_000))])
def test_the_woodpecker_keeps_the_order_too(order, levels):
    assert fitted_order(scenes.woodpecker(t_end=0.4), order, levels) > {2: 1.9, 4: 3.8}[order]


# --- obstacles that move, corners, a mass that changes


def jumping_belt(t, q, v, p, out):
    out[0] = -0.4 if t % 1.0 < 0.37 else 0.6


def seesaw(t, q, v, p, out):
    x = t % 1.0
    out[0, 0], out[0, 1], out[0, 2] = (0.3 * x, 0.3, 0.0) if x < 0.5 else (0.3 * (1.0 - x), -0.3, 0.0)


def outward(t, q):
    x = q[0] - 0.1 * math.sin(3.0 * t)
    r = math.hypot(x, q[1])
    return x / r, q[1] / r


def bowl(t, q, v, p, out):
    out[0] = 1.0 - math.hypot(q[0] - 0.1 * math.sin(3.0 * t), q[1])


def bowl_row(t, q, v, p, out):
    x, y = outward(t, q)
    out[0, 0], out[0, 1] = -x, -y


def bowl_rate(t, q, v, p, out):
    out[0] = 0.3 * outward(t, q)[0] * math.cos(3.0 * t)


def bowl_tangent(t, q, v, p, out):
    x, y = outward(t, q)
    out[0, 0], out[0, 1] = -y, x


def bowl_slip(t, q, v, p, out):
    out[0] = 0.3 * outward(t, q)[1] * math.cos(3.0 * t)


def growing_mass(t, q, v, p, out):
    out[0, 0], out[0, 1], out[1, 0], out[1, 1] = 1.0 + 0.3 * q[0] ** 2, 0.1, 0.1, 1.5


def on_a_belt_that_jumps():
    scene = driven([0.0, 0.0], restitution=0.3, friction=Coulomb(0.3, shaken_tangent, slip=jumping_belt))
    return replace(scene, corners=(0.0, 0.37), period=1.0)


def on_a_seesaw():
    friction = Coulomb(0.3, [[1.0, 0.0]])
    scene = driven([0.0, 0.0], restitution=0.3, motion=seesaw, friction=friction)
    return replace(scene, corners=(0.0, 0.5), period=1.0)


def in_a_bowl_that_swings():
    contacts = Contacts(
        1, bowl, bowl_row, gap_t=bowl_rate, restitution=0.5,
        friction=Coulomb(0.2, bowl_tangent, slip=bowl_slip),
    )  # fmt: skip
    return Scene(
        System(2, growing_mass, weight), q0=[0.5, -0.2], v0=[0.0, 0.0], t_span=(0.0, 3.0),
        contacts=contacts, period=2.0 * math.pi / 3.0,
    )  # fmt: skip


@pytest.mark.parametrize("order", ORDERS)
@pytest.mark.parametrize("make", [on_a_belt_that_jumps, on_a_seesaw, in_a_bowl_that_swings])
def test_corners_moving_obstacles_and_masses_cost_no_order(make, order):
    levels = {2: (300, 3000, 30_000), 4: (200, 500, 1300)}[order]  # beyond it, rounding
    assert fitted_order(make(), order, levels) > {2: 1.9, 4: 3.8}[order]
    assert np.max(simulate(make(), Located(1e-2, order=order)).penetration) < 1e-12


# --- by a tolerance


@pytest.mark.parametrize("order", ORDERS)
@pytest.mark.parametrize(
    "make",
    [on_a_shaken_floor, torn_off, pendulum, scenes.coulomb_oscillator, lambda: scenes.woodpecker(t_end=0.4)],
)
def test_errors_follow_the_tolerance(make, order):
    scene = make()
    t = np.linspace(*scene.t_span, 41)[1:]
    q, _ = simulate(scene, EventDriven(1e-13, 1e-13)).at(t)
    for tolerance in (1e-3, 1e-4, 1e-5) if order == 2 else (1e-4, 1e-6, 1e-8):
        method = Located(scene.t_span[1] / 3.0, order=order, tolerance=tolerance)
        run = simulate(scene, method, keep=t)
        error = np.max(np.abs(run.q - q)) / (1.0 + np.max(np.abs(q)))
        assert error < 3.0 * tolerance
        assert run.counts.steps < {2: 80.0 / tolerance**0.5, 4: 60.0 / tolerance**0.25}[order] * 5.0


def shaking_table(t, q, v, p, out):
    out[0, 0], out[0, 1] = 0.05 * math.sin(40.0 * t), 2.0 * math.cos(40.0 * t)
    out[0, 2] = -80.0 * math.sin(40.0 * t)


@pytest.mark.parametrize("restitution", [0.0, 0.8])
@pytest.mark.parametrize("order", ORDERS)
def test_steps_that_make_no_error_still_see_the_table_that_shakes(restitution, order):
    scene = Scene(
        system=LinearSystem(np.eye(2), force=[0.0, -G0]),
        contacts=LinearContacts(
            [[0.0, 1.0]], motion=shaking_table, restitution=restitution, friction=Coulomb(0.6, [[1.0, 0.0]])
        ),
        q0=[0.0, 0.3], v0=[2.0, 0.0], t_span=(0.0, 1.5), period=math.pi / 20.0,
    )  # fmt: skip
    exact = simulate(scene, EventDriven())
    run = simulate(scene, Located(1.0, order=order, tolerance=1e-4))
    assert np.array_equal(run.impacts.kind, exact.impacts.kind)
    assert np.max(np.abs(run.impacts.time - exact.impacts.time)) < 1e-6


def test_slips_between_the_ends_of_a_long_step_are_seen():
    """The block sticks exactly, its steps make no error; every second half of the force's period tears it off."""
    scene = Scene(
        system=LinearSystem(np.eye(2), force=Harmonic(constant=[0.0, -G0], sine=[3.5, 0.0], omega=3.0)),
        contacts=LinearContacts([[0.0, 1.0]], friction=Coulomb(0.355, [[1.0, 0.0]])),
        q0=[0.0, 0.0], v0=[0.0, 0.0], t_span=(0.0, 20.0), period=2.0 * math.pi / 3.0,
    )  # fmt: skip
    exact = simulate(scene, EventDriven())
    assert len(times(exact, Kind.SLIP)) == 19
    for order in ORDERS:
        run = simulate(scene, Located(20.0, order=order, tolerance=1e-6))
        assert np.array_equal(run.impacts.kind, exact.impacts.kind)
        assert np.max(np.abs(run.q[-1] - exact.q[-1])) < 1e-6


def test_a_tolerance_that_no_step_meets_is_said():
    run = simulate(scenes.coulomb_oscillator(), Located(1.0, order=4, tolerance=1e-16))
    assert run.status == Status.STEP_TOO_SMALL
    assert "tolerance" in run.message


def shaking(t, q, v, p, out):
    out[0, 0], out[0, 1], out[0, 2] = SHAKEN * math.sin(t), SHAKEN * math.cos(t), -SHAKEN * math.sin(t)


SHAKEN = 0.5  # m; at 1 rad/s far below the acceleration of gravity


@pytest.mark.parametrize(
    "method", [Located(0.1, tolerance=1e-4), Located(0.1, 4, tolerance=1e-6), Located(0.1, order=4)], ids=str
)
def test_between_its_steps_a_body_on_a_shaken_floor_stays_there(method):
    """Steps along the floor may be long, and say nothing of how it moves in between."""
    floor = LinearContacts([[0.0, 1.0]], motion=shaking, friction=Coulomb(0.4, [[1.0, 0.0]]))
    scene = Scene(
        LinearSystem(np.eye(2), force=[0.0, -9.81]), [0.0, 0.0], [3.0, SHAKEN], (0.0, 2.0), contacts=floor
    )
    m = simulate(scene, method)
    t = np.linspace(0.0, 2.0, 777)
    q, v = m.at(t)
    np.testing.assert_allclose(q[:, 1], SHAKEN * np.sin(t), atol=1e-12)
    np.testing.assert_allclose(v[:, 1], SHAKEN * np.cos(t), atol=1e-12)
    np.testing.assert_array_equal(simulate(scene, method, keep=t).q, q)


def shaken(t, q, v, p, out):
    for i in range(3):
        out[i, 0], out[i, 1] = p[0] * math.sin(p[1] * t), p[0] * p[1] * math.cos(p[1] * t)
        out[i, 2] = -p[0] * p[1] ** 2 * math.sin(p[1] * t)


def test_what_a_shaken_slope_lets_go_is_gone_though_its_acceleration_begins_by_rounding_below_zero():
    """Three blocks in a row of springs; a step of this size let one go and took it back at one time, without end."""
    m, long = np.array([0.414, 1.6, 0.865]), math.hypot(1.0, 0.26)
    G, T, K, weight = np.zeros((3, 6)), np.zeros((3, 6)), np.zeros((6, 6)), np.zeros(6)
    for i in range(3):
        G[i, 2 * i : 2 * i + 2], T[i, 2 * i : 2 * i + 2] = (
            (-0.26 / long, 1.0 / long),
            (1.0 / long, 0.26 / long),
        )
    K[::2, ::2] = 200.0 * np.array([[2.0, -1.0, 0.0], [-1.0, 2.0, -1.0], [0.0, -1.0, 1.0]])
    weight[1::2] = -9.81 * m
    blocks = LinearSystem(np.diag(np.repeat(m, 2)), K=K, force=weight)
    slope = LinearContacts(G, 0.0, 0.0, motion=shaken, friction=Coulomb(0.3, T))
    scene = Scene(blocks, np.zeros(6), np.zeros(6), (0.0, 0.2), slope, p=[0.069, 11.66])
    run, reference = simulate(scene, Located(0.001438)), simulate(scene, EventDriven())
    assert run.status is Status.DONE, run.message
    assert np.array_equal(run.impacts.kind, reference.impacts.kind)
    np.testing.assert_allclose(run.q[-1], reference.q[-1], rtol=0, atol=1e-5)
