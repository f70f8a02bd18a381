"""The exact answers of the catalogue, verified without any integrator: residuals, conservation, other arithmetic."""

import itertools
import math

import numpy as np
import pytest
from mpmath import mp, mpf

from lagrangian import LinearSystem, scenes
from lagrangian.scenes import dry_friction, table
from lagrangian.scenes.bouncing_ball import impact_times, rest_time
from lagrangian.scenes.cam_follower import NOSE_END, NOSE_START, detachment_rpm
from lagrangian.scenes.free import Free
from lagrangian.scenes.grazing import touch
from lagrangian.scenes.kane_pendulum import energy_change
from lagrangian.scenes.pendulum import rod
from lagrangian.scenes.piecewise import Piecewise
from tests.exact import IMPACT, RELEASE, Body, motion
from tests.exact import table as table_to_fifty_digits

OPEN = 1e-4  # a gap beyond it is not about to close [m]
ETA = 1e-5  # of the differences [s]
ALWAYS_CLOSED = (  # or touching: each has a test of its own
    "block-on-feet", "stack", "heavy-on-light", "rocking-block", "coulomb-oscillator", "slipping-wheel",
    "sliding-block", "newtons-cradle", "jumping-table",
)  # fmt: skip
EXACT = [
    scenes.bouncing_ball(), scenes.bouncing_ball(h0=0.5, v0=2.0, restitution=0.9), scenes.dyadic_ball(),
    scenes.elastic_ball(bounces=20), scenes.ball_on_table(t_end=1.0), scenes.chattering_table(),
    scenes.jumping_table(), scenes.jumping_table(after=-0.5), scenes.jumping_table(falling=1),
    scenes.impact_oscillator(t_end=30.0), scenes.sticking_oscillator(t_end=40.0), scenes.grazing(d=1e-2),
    scenes.pendulum_stop(), scenes.pendulum_stop(form="rod"), scenes.bowl(), scenes.bowl(x0=-0.3, y0=0.5),
    scenes.elastic_gas(), scenes.falling_gas(), scenes.galperin(k=1), scenes.newtons_cradle(),
    scenes.newtons_cradle(spacing=0.2), scenes.inelastic_collapse(), scenes.inelastic_collapse(restitution=0.3),
    scenes.block_on_feet(), scenes.stack(), scenes.heavy_on_light(), scenes.elastic_chain(n=2),
    scenes.elastic_chain(n=10), scenes.rocking_block(), scenes.rocking_block(form="corners"),
    scenes.coulomb_oscillator(), scenes.slipping_wheel(), scenes.sliding_block(), scenes.slope_landing(),
    scenes.slope_landing(mu=2.5), scenes.slope_landing(mu=0.2), scenes.cam_follower(t_end=0.5),
    scenes.cam_follower(rpm=120.0, t_end=1.0, coordinates="absolute"),
]  # fmt: skip


def accelerations(scene, t, q, v):
    """M^-1 f of the scene without its contacts, by its own definition."""
    system, p = scene.system, np.array(scene.p)
    if not isinstance(system, LinearSystem):
        M, f = np.zeros((scene.n_q, scene.n_q)), np.zeros(scene.n_q)
        if callable(system.mass):
            system.mass(t, q, v, p, M)
        else:
            M = np.array(system.mass)
        system.force(t, q, v, p, f)
        return np.linalg.solve(M, f)
    constant, cosine, sine = system.force.terms(scene.n_q)
    omega = system.force.omega
    f = constant + cosine * np.cos(omega * t) + sine * np.sin(omega * t) - system.C @ v - system.K @ q
    if system.frame is not None:
        c = np.zeros((scene.n_q, 3))
        system.frame(t, q, v, p, c)
        f = f - system.M @ c[:, 2] - system.C @ c[:, 1] - system.K @ c[:, 0]
    return np.linalg.solve(np.array(system.M), f)


@pytest.mark.parametrize("scene", EXACT, ids=lambda s: f"{s.name}-{list(s.parameters.values())[-1]}")
def test_exact_motions_stay_outside_and_obey_their_equation(scene):
    assert scene.exact is not None
    t_start, t_end = scene.t_span
    times = t_start + ETA + (t_end - t_start - 2 * ETA) * ((np.arange(400) + 0.37) / 400)
    q, v = scene.exact(times)
    assert q.shape == v.shape == (400, scene.n_q)
    size = 1.0 + np.max(np.abs(q))
    sides = [scene.exact(times + d) for d in (-ETA, ETA)]
    checked, moved = 0, []
    for k, t in enumerate(times):
        g, _ = scene.gap(t, q[k], v[k])
        assert np.all(g >= -1e-12 * size)
        moved.append(np.max(np.abs((sides[1][0][k] - sides[0][0][k]) / (2 * ETA) - v[k])))
        if np.min(g) < OPEN or scene.n_j > 0:
            continue
        around = (scene.gap(t + d, s[0][k], s[1][k])[0] for d, s in zip((-ETA, ETA), sides, strict=True))
        if any(np.min(beside) < OPEN for beside in around):
            continue
        a = (sides[1][1][k] - sides[0][1][k]) / (2 * ETA)
        wanted = accelerations(scene, t, q[k], v[k])
        assert np.max(np.abs(a - wanted)) <= 1e-5 * (1.0 + np.max(np.abs(wanted))), t
        checked += 1
    # velocities are the derivative of the positions but near impacts
    assert np.median(moved) < 1e-6 * (1.0 + np.max(np.abs(v)))
    assert checked > 0 or scene.n_j > 0 or scene.name in ALWAYS_CLOSED


def test_the_point_on_the_rod_stays_on_it_and_shares_the_angle_of_the_pendulum():
    scene, times = scenes.pendulum_stop(form="rod"), np.linspace(0.0, 5.0, 101)
    q, v = scene.exact(times)
    g = np.zeros(1)
    for x, dx in zip(q, v, strict=True):
        rod(0.0, x, dx, np.array(scene.p), g)
        assert abs(g[0]) < 1e-15
        assert abs(x @ dx) < 1e-14
    energy = 0.5 * np.sum(v**2, axis=1) + 9.81 * q[:, 1]
    levels = np.round((energy + 9.81) / (9.81 * (1 - math.cos(1.0))), 12)
    assert set(np.round(np.log(levels) / np.log(0.64), 6)) == set(range(len(set(levels))))  # e^2 an impact


# --- pieces in closed form, against fifty digits


def test_the_oscillator_agrees_with_fifty_digits():
    body = Body(
        c=2 * mpf(0.05), k=1, fc=1.0, Omega=2.0, r=0.8, side=-1, s=lambda t, w: (mpf(0), mpf(0), mpf(0))
    )
    expected = motion(body, -0.5, 0.0, 40.0).of_kind(IMPACT)
    mine = Piecewise(Free(0.05, 1.0, 0.0, -1.0, 0.0, 2.0), 0.8, (0.0, 0.5, 0.0))
    mine.state(40.0)
    hits = [t for t, _ in mine.impacts if t <= 40.0]
    assert len(hits) == len(expected)
    assert max(abs(float(mpf(t) - e[1])) for t, e in zip(hits, expected, strict=True)) < 1e-13


def test_the_chattering_ball_agrees_with_fifty_digits():
    A, w, r, h0 = 0.01, 40.0, 0.3, 0.02
    expected = motion(
        Body(f0=-mpf(9.81), r=r, s=table_to_fifty_digits(A, w), scan=mpf(1) / 1000), h0, 0.0, 0.5
    )
    scene = scenes.chattering_table(t_end=0.5)
    scene.exact(np.array([0.5]))
    releases = [float(e[1]) for e in expected.of_kind(RELEASE)]
    mine = [t for t in scene.exact.releases if t < 0.5]
    np.testing.assert_allclose(mine, releases, rtol=0, atol=1e-14)
    assert math.sin(40.0 * mine[0]) == pytest.approx(9.81 / 16.0, rel=1e-13)


def test_a_damped_and_an_overdamped_body_obey_their_equation():
    for delta, kappa in ((0.0, 0.0), (0.3, 1.0), (1.0, 1.0), (2.0, 1.0), (0.1, -0.5)):
        free = Free(delta if kappa else 0.0, kappa, 0.7, 0.4, -0.2, 1.3)
        for t in (0.5, 3.0):
            _, v, a = free.at(0.2, 0.3, -0.4, t)
            near = [free.at(0.2, 0.3, -0.4, t + d) for d in (-1e-4, 1e-4)]
            assert (near[1][0] - near[0][0]) / 2e-4 == pytest.approx(v, abs=1e-7)
            assert (near[1][1] - near[0][1]) / 2e-4 == pytest.approx(a, abs=1e-7)
        assert free.at(0.2, 0.3, -0.4, 0.2)[:2] == pytest.approx((0.3, -0.4), abs=1e-15)


# --- balls and tables


def test_the_ball_rests_after_infinitely_many_impacts():
    times = impact_times(1.0, 0.0, 9.81, 0.8, 400)
    assert times[-1] == pytest.approx(rest_time(1.0, 0.0, 9.81, 0.8), rel=1e-15)
    assert rest_time(1.0, 0.0, 9.81, 0.8) == pytest.approx(math.sqrt(2 / 9.81) * 9.0, rel=1e-15)
    np.testing.assert_array_equal(impact_times(1.0, 0.0, 2.0, 0.5, 5), [1.0, 2.0, 2.5, 2.75, 2.875])


def test_the_orbit_on_the_table_repeats_and_its_multipliers_are_those_of_the_impact_map():
    A, w, g, r = 0.01, 35.0, 9.81, 0.5
    phase = table.orbit_phase(A, w, g, r)
    step = 1e-6

    def hit(phi, v):
        """Impact map by bisection: phase and velocity after, from the phase and velocity after."""
        f = lambda s: A * math.sin(phi) + v * s - 0.5 * g * s * s - A * math.sin(phi + w * s)  # noqa: E731
        a, b = 0.5 * 2 * math.pi / w, 1.5 * 2 * math.pi / w
        for _ in range(200):
            m = 0.5 * (a + b)
            a, b = (m, b) if f(m) > 0 else (a, m)
        table_speed = A * w * math.cos(phi + w * a)
        return np.array([phi + w * a - 2 * math.pi, table_speed - r * (v - g * a - table_speed)])

    up = math.pi * g / w
    np.testing.assert_allclose(hit(phase, up), [phase, up], rtol=1e-12)
    columns = [
        (hit(phase + d[0], up + d[1]) - hit(phase - d[0], up - d[1])) / (2 * step) for d in np.eye(2) * step
    ]
    J = np.array(columns).T
    assert np.linalg.det(J) == pytest.approx(r * r, abs=1e-7)
    assert np.trace(J) == pytest.approx(table.orbit_trace(A, w, g, r), abs=1e-7)
    with pytest.raises(ValueError, match=r"^amplitude: "):
        table.orbit_phase(0.001, w, g, r)


def test_the_graze_is_that_of_the_rounded_depth():
    with mp.workdps(40):
        for d in (1e-2, 1e-8, 1e-14):
            q0 = mpf(0.5 * 1.03125**2 - d)  # of the initial state as it is stored
            depth = mpf(1.03125) ** 2 / 2 - q0
            assert touch(d, 1.0, 1.03125)[1] == pytest.approx(float(mp.sqrt(2 * depth)), rel=1e-15)


def test_a_table_that_jumps_takes_the_ball_along_or_leaves_it():
    for after in (0.5, -0.5):
        scene = scenes.jumping_table(at=0.3, before=0.1, after=after, t_end=0.31)
        _, v = scene.exact(np.array([0.3, 0.31]))
        np.testing.assert_allclose(v[0, 0], max(after, 0.1), rtol=1e-14)
        if after < 0:
            np.testing.assert_allclose(v[1, 0], 0.1 - 9.81 * 0.01, rtol=1e-12)


# --- cam, friction, the impact that creates energy


def test_the_follower_detaches_at_the_speeds_of_the_profile():
    assert detachment_rpm(NOSE_START) == pytest.approx(114.979, abs=5e-4)
    assert detachment_rpm(NOSE_END - 1e-12) == pytest.approx(134.873, abs=5e-4)
    with pytest.raises(ValueError, match=r"^beta: "):
        detachment_rpm(0.5)


def test_friction_scenes_obey_the_balance_of_work():
    # what friction takes is its force times the way that is slid
    scene = scenes.coulomb_oscillator()
    q, v = scene.exact(np.linspace(0.0, 5 * math.pi, 100_001))
    way = np.sum(np.abs(np.diff(q[:, 0])))
    energy = 0.5 * (q[:, 0] ** 2 + v[:, 0] ** 2)
    assert energy[0] - energy[-1] == pytest.approx(0.1 * way, rel=1e-9)
    assert dry_friction.half_cycles(1.05, 0.1) == 5
    assert q[-1, 0] == pytest.approx(-0.05, abs=1e-14)
    q, _ = scenes.sliding_block().exact(np.array([1.0]))
    assert q[0, 0] == pytest.approx(1.0 / (2 * 0.3 * 9.81), rel=1e-14)
    end = dry_friction.slip_time(1.0, 0.2, 0.5, 9.81)
    _, v = scenes.slipping_wheel().exact(np.array([end]))
    assert v[0, 0] + 0.3 * v[0, 2] == pytest.approx(0.0, abs=1e-15)
    assert end == pytest.approx(1.0 / (0.2 * 9.81 * 3.0), rel=1e-15)


def test_the_impact_of_kane_creates_or_loses_the_known_energy():
    change = {law: energy_change(scenes.kane_pendulum(law=law)) for law in ("newton", "moreau")}
    assert change["newton"] == pytest.approx(0.5875, abs=5e-5)
    assert change["moreau"] == pytest.approx(-0.4376, abs=5e-5)
    for r, mu in itertools.product((0.0, 0.3, 1.0), (0.1, 1.0)):
        assert energy_change(scenes.kane_pendulum(restitution=r, mu=mu)) <= 1e-14


def test_the_crank_starts_without_moving_the_slider_across():
    scene = scenes.slider_crank()
    g, u = scene.gap(0.0, scene.q0, scene.v0)
    np.testing.assert_allclose(g, 0.001, rtol=1e-12)
    np.testing.assert_allclose(u, 0.0, atol=1e-13)
