"""Steps with friction and every event at its own time: closed forms, orders, agreement with the event-driven run."""

import math
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

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
from lagrangian.scenes.rough_contacts import critical_friction
from lcpstep import EventDriven, Kind, LcpStepError, Located, Status, continued, simulate
from lcpstep import energy as energy_balance
from tests.events.test_friction import (
    G0,
    block,
    energy,
    rod,
    rod_row,
    shaken_slip,
    shaken_tangent,
    times,
    weight,
)
from tests.marks import shared
from tests.uncompiled import both_ways

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
    ("order", "levels"), [(2, (300, 3000, 30_000, 300_000)), (4, (100, 300, 1000, 3000))]
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


# --- closed forms


@pytest.mark.parametrize("order", ORDERS)
def test_the_coulomb_oscillator_turns_at_multiples_of_pi_and_stops_at_its_place(order):
    for h, size in ((0.05, 1.0), (0.005, 0.1)):
        run = simulate(scenes.coulomb_oscillator(), Located(h, order=order))
        turned = np.append(times(run, Kind.REVERSE), times(run, Kind.STICK_TANGENT))
        assert np.max(np.abs(turned - math.pi * np.arange(1, 6))) < 0.01 * size**order
        assert abs(run.q[-1, 0] + 0.05) < 2e-3 * size**order
        stopped = run.t > turned[-1]
        assert np.all(run.v[stopped] == 0.0)
        assert np.ptp(run.q[stopped], axis=0).tolist() == [0.0, 0.0]


@pytest.mark.parametrize("order", ORDERS)
@pytest.mark.parametrize(
    "scene",
    [
        scenes.slipping_wheel(),
        scenes.slipping_wheel(v0=2.0, mu=0.4, beta=1.0),
        scenes.sliding_block(),
        scenes.slope_landing(),
        scenes.slope_landing(slope=0.9, mu=0.3),
    ],
    ids=lambda s: s.name,
)
def test_motion_under_constant_forces_is_exact(scene, order):
    run = simulate(scene, Located(0.0377, order=order))
    t = np.linspace(*scene.t_span, 301)
    q, v = run.at(t)
    away = np.min(np.abs(t[:, None] - run.impacts.time), axis=1, initial=1.0) > 1e-3
    exact_q, exact_v = scene.exact(t)
    assert np.max(np.abs(q - exact_q)) < 1e-13 * (1.0 + np.max(np.abs(exact_q)))
    assert np.max(np.abs(v - exact_v)[away]) < 1e-12 * (1.0 + np.max(np.abs(exact_v)))


def test_the_friction_impulse_is_what_the_momentum_has_lost():
    run = simulate(scenes.slope_landing(), Located(1e-2))
    t = run.t[-1]
    along = 3.0 + G0 * math.sin(0.3) * t + np.sum(run.friction_impulse)
    assert abs(along - run.v[-1, 0]) < 1e-12
    assert abs(np.sum(run.impulse) - G0 * math.cos(0.3) * t) < 1e-11


@pytest.mark.parametrize("order", ORDERS)
def test_a_block_on_a_shaken_table_goes_with_the_event_driven_run(order):
    scene = Scene(
        system=LinearSystem(np.eye(2), force=[0.0, -G0]),
        contacts=LinearContacts([[0.0, 1.0]], friction=Coulomb(0.3, shaken_tangent, slip=shaken_slip)),
        q0=[0.0, 0.0], v0=[0.0, 0.0], t_span=(0.0, 3.0),
    )  # fmt: skip
    exact = simulate(scene, EventDriven())
    run = simulate(scene, Located(1e-2, order=order))
    turned = times(exact, Kind.REVERSE)
    assert len(times(run, Kind.REVERSE)) == len(turned) > 15
    # between two meetings the block has the acceleration +- mu g, which both orders follow exactly
    assert np.max(np.abs(times(run, Kind.REVERSE) - turned)) < 1e-13
    assert abs(run.q[-1, 0] - exact.q[-1, 0]) < 1e-13


@pytest.mark.parametrize("order", ORDERS)
def test_impulses_are_the_momentum_of_a_block_that_rocks_and_slides(order):
    run = simulate(scenes.sliding_rocking_block(), Located(1e-2, order=order))
    gained = run.v[-1, :2] - run.scene.v0[:2]
    assert abs(np.sum(run.friction_impulse) - gained[0]) < 1e-12
    assert abs(np.sum(run.impulse) - G0 * run.t[-1] - gained[1]) < 1e-12


def test_kanes_pendulum_leaves_its_impact_as_the_law_says():
    from lagrangian.scenes.kane_pendulum import after_impact

    for law in ("moreau", "newton"):
        scene = scenes.kane_pendulum(law=law)
        run = simulate(scene, Located(1e-4))
        assert np.max(np.abs(run.v[0] - after_impact(scene))) < 1e-10


@pytest.mark.parametrize("order", ORDERS)
@pytest.mark.parametrize("mu", [0.05, 0.6])
def test_a_block_bounces_along_and_its_impulses_are_those_of_coulomb(mu, order):
    scene = Scene(
        system=LinearSystem(np.eye(2), force=[0.0, -G0]),
        contacts=LinearContacts([[0.0, 1.0]], restitution=0.8, friction=Coulomb(mu, [[1.0, 0.0]])),
        q0=[0.0, 0.5], v0=[4.0, 0.0], t_span=(0.0, 3.0),
    )  # fmt: skip
    run = simulate(scene, Located(0.1, order=order))
    if mu < 0.1:  # while it slides, friction is mu times what the weight and the impacts press with
        assert abs(run.v[-1, 0] - (4.0 - mu * (G0 * 3.0))) < 1e-10
    else:
        assert np.all(run.v[-1] == 0.0)
    assert abs(np.sum(run.impulse) - G0 * 3.0) < 1e-10


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


# --- agreement with the event-driven method


@pytest.mark.parametrize("seed", range(20))
def test_random_discs_and_blocks_go_with_the_event_driven_run(seed):
    scene, t = block(seed), np.linspace(0.05, 1.0, 20)
    exact, _ = simulate(scene, EventDriven(1e-12, 1e-12)).at(t)
    for order, (few, many) in {2: (400, 1600), 4: (100, 400)}.items():
        coarse, fine = (
            np.max(np.abs(simulate(scene, Located(1.0 / n, order=order), keep=t).q - exact))
            for n in (few, many)
        )
        assert fine < 1e-11 or fine < coarse / (0.6 * 4**order)


@pytest.mark.parametrize(("seed", "order", "n"), [(5, 2, 1603), (37, 4, 400)])
def test_feet_that_touch_down_far_slower_than_they_slide_find_their_impulses(seed, order, n):
    """At the end of a chattering, the last approach being as slow as the rounding of the sliding velocity."""
    run = simulate(block(seed), Located(1.0 / n, order=order), keep=[0.05, 1.0])
    assert run.status is Status.DONE, run.message


@pytest.mark.parametrize("seed", shared(range(1000, 1150), 10))
def test_more_random_discs_and_blocks_go_with_the_event_driven_run(seed):
    scene, t = block(seed), np.linspace(0.05, 1.0, 20)
    exact, _ = simulate(scene, EventDriven(1e-12, 1e-12)).at(t)
    for order, n in ((2, 10_000), (4, 1000)):
        run = simulate(scene, Located(1.0 / n, order=order), keep=t)
        assert np.max(np.abs(run.q - exact)) < 1e-5


@settings(max_examples=30, deadline=None)
@given(st.integers(0, 10**6), st.sampled_from(ORDERS))
def test_no_energy_comes_from_friction_impulses_lie_in_the_cone_and_nothing_is_passed(seed, order):
    scene = block(seed)
    run = simulate(scene, Located(1e-3, order=order))
    assert run.status == Status.DONE, run.message
    E = energy(scene, run.q, run.v)
    assert np.max(np.diff(E)) < {2: 1e-5, 4: 1e-9}[order] * (1.0 + E[0])  # that of the smooth motion
    assert np.min(run.impulse) > -1e-9
    assert np.all(np.abs(run.friction_impulse) <= scene.contacts.friction.mu * run.impulse + 1e-12)
    assert np.max(run.penetration) < 1e-12


# --- Painleve


@pytest.mark.parametrize("order", ORDERS)
def test_a_rod_that_jams_is_named_with_its_critical_coefficient(order):
    scene = scenes.falling_rod(mu=1.05 * critical_friction(0.9), angle=0.9, t_end=1e-3)
    run = simulate(scene, Located(1e-4, order=order))
    assert run.status == Status.PAINLEVE_INCONSISTENT
    assert abs(float(run.message.split("state: ")[1].split(")")[0]) - critical_friction(0.9)) < 1e-7


# --- what is made of such runs


@pytest.mark.parametrize("seed", [3, 8, 21])
@pytest.mark.parametrize("order", ORDERS)
def test_the_motion_does_not_depend_on_what_is_kept(seed, order):
    scene, method = block(seed), Located(1.7e-3, order=order)
    whole, some, few = (simulate(scene, method, keep=keep) for keep in (1, [0.3, 1.0], 7))
    for run in (some, few):
        assert np.array_equal(whole.q[-1], run.q[-1])
        assert np.array_equal(whole.impacts, run.impacts)
        total = np.sum(whole.friction_impulse, axis=0)
        assert np.allclose(total, np.sum(run.friction_impulse, axis=0), atol=1e-12)
    assert np.allclose(whole.at(0.3)[0], some.q[0], rtol=0.0, atol=1e-14)
    assert whole.counts.steps == math.ceil(1.0 / 1.7e-3)
    assert len(few.t) < len(whole.t) / 4


def test_a_run_with_friction_goes_on_from_its_end():
    method = Located(1e-2, order=4)
    first = simulate(scenes.coulomb_oscillator(t_end=5.0), method)
    second = simulate(continued(first, t_end=20.0), method)
    whole = simulate(scenes.coulomb_oscillator(), method)
    assert np.max(np.abs(second.q[-1] - whole.q[-1])) < 1e-10


def test_the_energy_that_friction_takes_never_comes_back():
    for scene in (scenes.sliding_block(), scenes.slope_landing(), scenes.slider_crank()):
        E = energy_balance(simulate(scene, Located(1e-4, order=4)))
        assert np.min(np.diff(E.friction)) > -1e-8
        assert len(E.created) == 0


def test_errors_and_audits_are_taken():
    scene = scenes.coulomb_oscillator()
    run = simulate(scene, Located(2e-2, audit=True), error=True)
    t = np.linspace(*scene.t_span, 2001)
    true = np.max(np.abs(run.at(t)[0] - scene.exact(t)[0]))
    assert 0.5 < true / run.error.position.sup < 2.0
    assert run.audit is not None


def test_what_is_refused_is_named():
    with pytest.raises(LcpStepError, match="order='exact' does not treat friction"):
        simulate(scenes.sliding_block(), Located(1e-2, "exact"))


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


PROGRAM = """
from lagrangian import scenes
from lcpstep import Located, simulate

for order, tolerance in ((2, None), (4, None), (4, 1e-5)):
    for scene in (scenes.coulomb_oscillator(t_end=4.0), scenes.woodpecker(t_end=0.04)):
        method = Located(scene.t_span[1] / 50, order=order, tolerance=tolerance)
        run = simulate(scene, method, keep=1)
        print(len(run.t), run.counts, *(float(x).hex() for x in (*run.q[-1], *run.v[-1], *run.impacts.impulse)))
"""


def test_the_kernels_as_plain_python_give_the_same(tmp_path):
    built, plain = both_ways(tmp_path, PROGRAM)
    assert built == plain


def impact_of_the_orbit(scene, method):
    """Period and state at the last but one impact of contact 0."""
    run = simulate(scene, method, keep="impacts")
    hit = run.impacts.time[(run.impacts.kind == Kind.IMPACT) & (run.impacts.contact == 0)]
    return hit[-1] - hit[-2], np.concatenate(run.at(hit[-2:-1]), axis=1)[0]


def test_the_woodpeckers_orbit_is_the_same_to_ten_digits():
    period, x = impact_of_the_orbit(scenes.woodpecker(t_end=30.0), EventDriven(1e-13, 1e-13))
    scene = replace(scenes.woodpecker(), q0=x[:3], v0=x[3:], t_span=(0.0, 6.2 * period))
    for method, digits in (
        (EventDriven(1e-12, 1e-12), 11.0),
        (Located(1e-5, order=4), 10.0),
        (Located(1e-5), 5.5),
    ):
        found, y = impact_of_the_orbit(scene, method)
        assert abs(found / period - 1.0) < 10.0**-digits
        assert np.max(np.abs(y - x)[1:]) < 10.0**-digits * np.max(np.abs(x[1:]))
