"""Planar friction event by event, against motions in closed form and the laws of impact."""

import math

import numpy as np
import pytest

from lagrangian import Coulomb, Harmonic, LinearContacts, LinearSystem, Scene, scenes
from lagrangian.scenes.dry_friction import slip_time
from lagrangian.scenes.rocking_block import impact_ratio, rocking_times
from lcpstep import EventDriven, Kind, Status, simulate
from tests.events.rough import G0, shaken_slip, shaken_tangent, times

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


# --- closed forms


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


@pytest.mark.parametrize("scene", [scenes.woodpecker(), scenes.slider_crank()], ids=lambda s: s.name)
def test_an_impact_is_told_with_the_speed_that_its_law_gives(scene):
    """To the last digit, which adding up what impulses change does not know."""
    run = simulate(scene, EventDriven())
    struck = run.impacts[run.impacts.kind == Kind.IMPACT]
    restitution = np.broadcast_to(scene.contacts.restitution, scene.n_c)[struck.contact]
    assert len(struck) > 4
    np.testing.assert_array_equal(struck.after, -restitution * np.minimum(struck.before, 0.0))
