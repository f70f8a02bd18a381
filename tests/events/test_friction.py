"""Planar friction event by event: closed forms, energy, paradoxes, agreement with Moreau's scheme."""

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from lagrangian import (
    Coulomb,
    Harmonic,
    Joints,
    LinearContacts,
    LinearSystem,
    Scene,
    System,
    scenes,
)
from lagrangian.scenes.dry_friction import slip_time
from lagrangian.scenes.rocking_block import impact_ratio, rocking_times
from lagrangian.scenes.rough_contacts import critical_friction
from lcpstep import EventDriven, Kind, Moreau, Status, continued, simulate
from lcpstep import energy as energy_balance
from tests.uncompiled import both_ways

G0 = 9.81


def times(run, kind, contact=0):
    """When this happened at a contact."""
    chosen = (run.impacts.kind == kind) & (run.impacts.contact == contact)
    return run.impacts.time[chosen]


def at_end(scene, *methods):
    """Positions at the end of the span by these methods."""
    return [simulate(scene, method, keep=[scene.t_span[1]]).q[-1] for method in methods]


# --- closed forms


@pytest.mark.parametrize(
    "scene",
    [
        scenes.coulomb_oscillator(),
        scenes.coulomb_oscillator(x0=-3.3, drag=0.25),
        scenes.slipping_wheel(),
        scenes.slipping_wheel(v0=2.0, mu=0.4, beta=1.0),
        scenes.sliding_block(),
        scenes.slope_landing(),
        scenes.slope_landing(slope=0.9, mu=0.3),
        scenes.mass_on_belt(x0=-2.5, v0=0.9, belt=0.5, mu=0.1, t_end=20.0),
        scenes.mass_on_shaken_belt(),
        scenes.stick_slip_belt(belt=0.5),
        scenes.superball(),
        scenes.superball(v0=3.0, mu=0.1),
    ],
    ids=lambda s: s.name,
)
@pytest.mark.parametrize("tolerance", [1e-5, 1e-8, 1e-11])
def test_motions_with_dry_friction_follow_the_tolerance(scene, tolerance):
    run = simulate(scene, EventDriven(tolerance, tolerance))
    t = np.linspace(*scene.t_span, 301)
    q, v = run.at(t)
    away = np.min(np.abs(t[:, None] - run.impacts.time), axis=1, initial=1.0) > 1e-3
    exact_q, exact_v = scene.exact(t)
    size = 1.0 + np.max(np.abs(exact_q))
    assert run.status == Status.DONE
    assert np.max(np.abs(q - exact_q)) < 10.0 * tolerance * size
    assert np.max(np.abs(v - exact_v)[away]) < 10.0 * tolerance * (1.0 + np.max(np.abs(exact_v)))


def test_the_coulomb_oscillator_turns_at_multiples_of_pi_and_stops_at_its_place():
    run = simulate(scenes.coulomb_oscillator(), EventDriven())
    assert np.max(np.abs(times(run, Kind.REVERSE) - math.pi * np.arange(1, 5))) < 1e-11
    assert abs(times(run, Kind.STICK_TANGENT)[0] - 5.0 * math.pi) < 1e-11
    assert abs(run.q[-1, 0] + 0.05) < 1e-12
    assert np.all(run.v[-1] == 0.0)


@pytest.mark.parametrize("tolerance", [1e-9, 1e-12])
def test_a_block_on_two_corners_strikes_at_its_times_however_short_its_flights(tolerance):
    """A gap that opens and closes within one step is as small at the impact as after a long flight."""
    scene = scenes.rocking_block(form="corners")
    b, h = 0.1, 0.4
    p = math.sqrt(0.75 * G0 / math.hypot(b, h))
    exact, rates = rocking_times(0.15, math.atan2(b, h), p, impact_ratio(b, h), 60)
    run = simulate(scene, EventDriven(tolerance, tolerance), keep="impacts")
    struck = run.impacts[run.impacts.kind == Kind.IMPACT][:60]
    assert np.max(np.abs(struck.time - exact)) < 40.0 * tolerance
    np.testing.assert_allclose(struck.before, -2.0 * b * rates, rtol=0, atol=10.0 * tolerance)
    angles = [run.q[np.flatnonzero(run.t == t)[-1], 2] for t in struck.time]
    assert np.max(np.abs(angles)) < 0.1 * tolerance


def test_a_wheel_begins_to_roll_at_its_time():
    run = simulate(scenes.slipping_wheel(), EventDriven())
    assert abs(times(run, Kind.STICK_TANGENT)[0] - slip_time(1.0, 0.2, 0.5, G0)) < 1e-12


def test_the_friction_impulse_is_what_the_momentum_has_lost():
    run = simulate(scenes.slope_landing(), EventDriven())
    t = run.t[-1]
    along = 3.0 + G0 * math.sin(0.3) * t + np.sum(run.friction_impulse)
    assert abs(along - run.v[-1, 0]) < 1e-11
    assert abs(np.sum(run.impulse) - G0 * math.cos(0.3) * t) < 1e-11


def shaken_tangent(t, q, v, p, out):
    out[0, 0], out[0, 1] = 1.0, 0.0


def shaken_slip(t, q, v, p, out):
    out[0] = -0.4 * math.cos(20.0 * t)


def test_a_block_on_a_shaken_table_slides_to_where_its_phases_say():
    scene = Scene(
        system=LinearSystem(np.eye(2), force=[0.0, -G0]),
        contacts=LinearContacts([[0.0, 1.0]], friction=Coulomb(0.3, shaken_tangent, slip=shaken_slip)),
        q0=[0.0, 0.0], v0=[0.0, 0.0], t_span=(0.0, 3.0),
    )  # fmt: skip
    run = simulate(scene, EventDriven())
    # from one meeting of the velocities to the next the block has the acceleration +- mu g
    t, x, v, side = 0.0, 0.0, 0.0, 1.0
    while True:
        a = 0.3 * G0 * side

        def gap(s, t=t, v=v, a=a):
            return v + a * s - 0.4 * math.cos(20.0 * (t + s))

        s = 1e-9
        while gap(s) * side < 0.0:
            s += 1e-3
        low, high = s - 1e-3, s
        for _ in range(100):
            middle = 0.5 * (low + high)
            low, high = (middle, high) if gap(middle) * side < 0.0 else (low, middle)
        step = min(high, 3.0 - t)
        x, v, t, side = x + step * (v + 0.5 * a * step), v + a * step, t + step, -side
        if t >= 3.0:
            break
    assert abs(run.q[-1, 0] - x) < 1e-11
    assert abs(x + 6.283e-5) < 1e-8


EDGE_LOADS = [
    (1, 0.3),
    (1, 0.5),
    (2, 0.3),
]  # of two feet with mu_s > mu it is not determined when they give way


@pytest.mark.parametrize(("feet", "mu_s"), EDGE_LOADS)
@pytest.mark.parametrize("grows", [True, False])
def test_a_force_that_begins_at_the_edge_of_the_cone_slides_only_if_it_grows(feet, mu_s, grows):
    """x'' = F(t) with F(0) = mu_s N exactly: nothing moves under mu_s cos t, under mu_s (1 + sin t) it slides."""
    rows = [[0.0, 1.0, 0.0]] if feet == 1 else [[0.0, 1.0, 1.0], [0.0, 1.0, -1.0]]
    constant, along = [mu_s if grows else 0.0, -1.0, 0.0], [mu_s, 0.0, 0.0]
    force = (
        Harmonic(constant, sine=along, omega=1.0) if grows else Harmonic(constant, cosine=along, omega=1.0)
    )
    scene = Scene(
        system=LinearSystem(np.eye(3), force=force),
        contacts=LinearContacts(rows, friction=Coulomb(0.3, [[1.0, 0.0, 0.0]] * feet, mu_s=mu_s)),
        q0=[0.0] * 3, v0=[0.0] * 3, t_span=(0.0, 1.5),
    )  # fmt: skip
    run = simulate(scene, EventDriven())
    x = 0.5 * (mu_s - 0.3) * 1.5**2 + mu_s * (1.5 - math.sin(1.5)) if grows else 0.0
    assert abs(run.q[-1, 0] - x) < 1e-9
    assert grows or np.all(run.v == 0.0)


# --- impacts


def test_kanes_pendulum_leaves_its_impact_as_the_law_says():
    from lagrangian.scenes.kane_pendulum import after_impact

    for law in ("moreau", "newton"):
        scene = scenes.kane_pendulum(law=law)
        run = simulate(scene, EventDriven())
        assert np.max(np.abs(run.v[0] - after_impact(scene))) < 1e-10


@pytest.mark.parametrize("restitution", [0.0, 0.5, 0.8])
@pytest.mark.parametrize("mu", [0.05, 0.6])
def test_a_block_that_bounces_on_a_floor_keeps_sliding_and_its_impulses_are_those_of_coulomb(restitution, mu):
    scene = Scene(
        system=LinearSystem(np.eye(2), force=[0.0, -G0]),
        contacts=LinearContacts([[0.0, 1.0]], restitution=restitution, friction=Coulomb(mu, [[1.0, 0.0]])),
        q0=[0.0, 0.5], v0=[4.0, 0.0], t_span=(0.0, 3.0),
    )  # fmt: skip
    run = simulate(scene, EventDriven(1e-11, 1e-11))
    # while it slides, all normal impulses together are m (g t + v_N), and friction is mu times that
    if mu < 0.1:
        assert abs(run.v[-1, 0] - (4.0 - mu * (G0 * 3.0))) < 1e-9
    else:
        assert np.all(run.v[-1] == 0.0)
    assert abs(np.sum(run.impulse) - G0 * 3.0) < 1e-9


# --- what no friction may do


def block(seed):
    """A disc or a block with two feet, a floor and a wall, with springs, belts and restitution drawn."""
    rng = np.random.default_rng(seed)
    disc = rng.random() < 0.5
    if disc:
        M, rows, tangents = np.diag([1.0, 1.0, 0.045]), [[0, 1, 0], [-1, 0, 0]], [[1, 0, 0.3], [0, 1, 0.3]]
        offset = [0.2, 0.6]
    else:
        height = rng.uniform(0.05, 0.5)
        M, rows, tangents = np.diag([1.0, 1.0, 0.1]), [[0, 1, 0.3], [0, 1, -0.3]], [[1, 0, height]] * 2
        offset = [0.0, 0.0]
    v0 = rng.normal(size=3) * [1.5, 1.0, 2.0]
    v0[1] = abs(v0[1])
    v0[2] *= 1.0 if disc else 0.05
    return Scene(
        system=LinearSystem(M, K=np.diag([rng.uniform(0, 30), 0.0, 0.0]), force=[0.0, -G0, 0.0]),
        contacts=LinearContacts(
            rows, offset=offset, restitution=rng.choice([0.0, 0.3, 0.6]),
            friction=Coulomb(rng.uniform(0.0, 1.2, 2), tangents),
        ),
        q0=[0.0, 0.0, 0.0], v0=v0, t_span=(0.0, 1.0),
    )  # fmt: skip


def energy(scene, q, v):
    s = scene.system
    return 0.5 * np.sum(v @ s.M * v, axis=1) + 0.5 * np.sum(q @ s.K * q, axis=1) + G0 * q[:, 1]


@settings(max_examples=30, deadline=None)
@given(st.integers(0, 10**6))
def test_energy_never_grows_impulses_lie_in_the_cone_and_nothing_is_passed(seed):
    scene = block(seed)
    run = simulate(scene, EventDriven(1e-11, 1e-11))
    assert run.status == Status.DONE, run.message
    E = energy(scene, run.q, run.v)
    assert np.max(np.diff(E)) < 1e-8 * (1.0 + E[0])
    assert np.min(run.impulse) > -1e-9
    assert np.all(np.abs(run.friction_impulse) <= scene.contacts.friction.mu * run.impulse + 1e-8)
    assert np.max(run.penetration) < 1e-8


@pytest.mark.slow
@pytest.mark.parametrize("seed", range(12))
def test_moreaus_scheme_comes_to_the_same_motion(seed):
    scene = block(seed)
    exact, coarse, fine = at_end(scene, EventDriven(1e-10, 1e-10), Moreau(2e-4), Moreau(2e-6))
    assert np.max(np.abs(fine - exact)) < 0.2 * np.max(np.abs(coarse - exact)) + 2e-6


@pytest.mark.parametrize("seed", [3, 8, 21])
def test_the_motion_does_not_depend_on_what_is_kept(seed):
    scene, method = block(seed), EventDriven(1e-10, 1e-10)
    whole, some = simulate(scene, method), simulate(scene, method, keep=[0.3, 1.0])
    assert np.allclose(whole.q[-1], some.q[-1], rtol=0.0, atol=1e-14)
    assert np.array_equal(whole.impacts.kind, some.impacts.kind)
    assert np.allclose(whole.impacts.time, some.impacts.time, rtol=0.0, atol=1e-14)
    assert np.allclose(
        np.sum(whole.friction_impulse, axis=0), np.sum(some.friction_impulse, axis=0), atol=1e-13
    )
    assert np.allclose(whole.at(0.3)[0], some.q[0], atol=1e-12)


# --- several contacts, joints, obstacles that move


def test_two_feet_that_share_their_load_stick_and_slide_as_one():
    """Both tangents are the same row; the block slides once the force exceeds mu times its weight."""
    scene = Scene(
        system=LinearSystem(
            np.diag([1.0, 1.0, 0.1]), force=Harmonic(constant=[0, -G0, 0], sine=[6.0, 0, 0], omega=1.0)
        ),
        contacts=LinearContacts([[0, 1, 0.3], [0, 1, -0.3]], friction=Coulomb([0.3, 0.5], [[1, 0, 0.0]] * 2)),
        q0=[0.0] * 3, v0=[0.0] * 3, t_span=(0.0, 1.5),
    )  # fmt: skip
    run = simulate(scene, EventDriven())
    begin = math.asin(0.4 * G0 / 6.0)  # half the weight on each
    assert abs(min(times(run, Kind.SLIP, 0)[0], times(run, Kind.SLIP, 1)[0]) - begin) < 1e-9
    tau = 1.5 - begin
    x = 6.0 * (math.cos(begin) * tau - (math.sin(1.5) - math.sin(begin))) - 0.2 * G0 * tau**2
    assert abs(run.q[-1, 0] - x) < 1e-9


def rod(t, q, v, p, out):
    out[0] = q[0] ** 2 + q[1] ** 2 - 1.0


def rod_row(t, q, v, p, out):
    out[0, 0], out[0, 1] = 2.0 * q[0], 2.0 * q[1]


def weight(t, q, v, p, out):
    out[0], out[1] = 0.0, -G0


def test_a_pendulum_drags_along_a_wall():
    scene = Scene(
        system=System(2, np.eye(2), weight), joints=Joints(1, rod, rod_row),
        contacts=LinearContacts([[1.0, 0.0]], restitution=0.4, friction=Coulomb(0.3, [[0.0, 1.0]])),
        q0=[math.sin(1.0), -math.cos(1.0)], v0=[0.0, 0.0], t_span=(0.0, 2.0),
    )  # fmt: skip
    exact, coarse, fine = at_end(scene, EventDriven(1e-11, 1e-11), Moreau(1e-3), Moreau(1e-5))
    assert np.max(np.abs(fine - exact)) < 0.05 * np.max(np.abs(coarse - exact)) + 1e-6


def test_the_woodpecker_pecks_seven_times_a_second_whatever_the_tolerance():
    scene = scenes.woodpecker()
    run, again = (simulate(scene, EventDriven(tol, tol)) for tol in (1e-12, 1e-9))
    pecks = times(run, Kind.IMPACT)
    assert np.all(np.abs(np.diff(pecks) - 0.14596) < 2e-4)
    assert np.max(np.abs(run.q[-1] - again.q[-1])) < 1e-8
    errors = [np.max(np.abs(q - run.q[-1])) for q in at_end(scene, Moreau(1e-4), Moreau(1e-5), Moreau(1e-6))]
    assert errors[1] < 0.2 * errors[0]
    assert errors[2] < 0.2 * errors[1]


# --- Painleve


@settings(max_examples=20, deadline=None)
@given(st.floats(0.3, 1.4), st.floats(0.9, 1.1))
def test_a_rod_that_jams_is_named_with_its_critical_coefficient(angle, share):
    mu = share * critical_friction(angle)
    run = simulate(scenes.falling_rod(mu=mu, angle=angle, t_end=1e-3), EventDriven())
    if share > 1.0 + 1e-9:
        assert run.status == Status.PAINLEVE_INCONSISTENT
        said = float(run.message.split("state: ")[1].split(")")[0])
        assert abs(said - critical_friction(angle)) < 1e-7
    elif share < 0.99:
        assert run.status == Status.DONE


def test_no_rod_jams_below_four_thirds():
    angles = np.linspace(0.05, 1.5, 500)
    assert min(critical_friction(a) for a in angles) >= 4.0 / 3.0
    assert abs(critical_friction(math.atan(2.0)) - 4.0 / 3.0) < 1e-14
    for angle in (0.8, 1.1, 1.3):
        assert simulate(scenes.falling_rod(mu=1.3, angle=angle), EventDriven()).status == Status.DONE


def test_a_rod_that_lifts_off_or_stays_is_indeterminate():
    """Turning fast, the tip would lift off; pressed by friction it could as well stay."""
    scene = scenes.falling_rod(mu=2.0, angle=1.1)
    turning = Scene(
        system=scene.system, contacts=scene.contacts, q0=scene.q0, p=scene.p, t_span=(0.0, 0.1),
        v0=[-4.0, 0.5 * math.cos(1.1) * 6.0, 6.0],
    )  # fmt: skip
    assert simulate(turning, EventDriven()).status == Status.PAINLEVE_INDETERMINATE


# --- what is made of such runs


def test_a_run_with_friction_goes_on_from_its_end():
    scene = scenes.coulomb_oscillator(t_end=5.0)
    first = simulate(scene, EventDriven())
    second = simulate(continued(first, t_end=20.0), EventDriven())
    whole = simulate(scenes.coulomb_oscillator(), EventDriven())
    assert np.max(np.abs(second.q[-1] - whole.q[-1])) < 1e-11


def test_the_energy_that_friction_takes_never_comes_back():
    for scene in (scenes.sliding_block(), scenes.slope_landing(), scenes.slider_crank()):
        E = energy_balance(simulate(scene, EventDriven(1e-11, 1e-11)))
        assert np.min(np.diff(E.friction)) > -1e-8
        assert len(E.created) == 0
    E = energy_balance(simulate(scenes.sliding_block(), EventDriven()))
    assert abs(E.friction[-1] - 0.5) < 1e-12


PROGRAM = """
from lagrangian import scenes
from lcpstep import EventDriven, simulate

for scene in (scenes.coulomb_oscillator(t_end=4.0), scenes.woodpecker(t_end=0.04)):
    run = simulate(scene, EventDriven(rtol=1e-7, atol=1e-7), keep=1)
    print(len(run.t), run.counts, *(float(x).hex() for x in (*run.q[-1], *run.v[-1], *run.impacts.impulse)))
"""


def test_the_kernels_as_plain_python_give_the_same(tmp_path):
    built, plain = both_ways(tmp_path, PROGRAM)
    assert built == plain
