"""What every single step obeys: balance of momentum, complementarity on its active set, and how positions move."""

from functools import cache

import numpy as np
import pytest

from lagrangian import Harmonic, LinearContacts, LinearSystem, Scene, scenes
from lcpstep import Moreau, simulate
from tests.models import ball_on_table

THETAS = [0.0, 0.5, 0.75, 1.0]


def three_masses(restitution=(0.5, 0.8, 0.0, 1.0), t_end=4.0):
    """Three masses on a line between two walls, coupled, damped and driven: four contacts."""
    G = [[1.0, 0.0, 0.0], [-1.0, 1.0, 0.0], [0.0, -1.0, 1.0], [0.0, 0.0, -1.0]]
    return Scene(
        system=LinearSystem(
            M=[[2.0, 0.1, 0.0], [0.1, 1.0, 0.0], [0.0, 0.0, 0.5]],
            C=0.1 * np.eye(3),
            K=[[3.0, -1.0, 0.0], [-1.0, 3.0, -1.0], [0.0, -1.0, 2.0]],
            force=Harmonic(constant=[0.0, 1.0, 0.0], cosine=[4.0, 0.0, -3.0], sine=[0.0, 2.0, 0.0], omega=3.0),
        ),
        contacts=LinearContacts(G=G, offset=[0.2, 0.2, 0.2, 0.2], restitution=restitution),
        q0=[0.0, 0.0, 0.0], v0=[1.0, -2.0, 1.5], t_span=(0.0, t_end), name="three masses",
    )  # fmt: skip


@cache
def motion(scene, h, theta=0.5):
    return simulate(scene, Moreau(h, theta))


@cache
def obstacles(scene, times):
    """s and s' of the obstacles."""
    out = np.zeros((len(times), scene.n_c, 3))
    if scene.contacts.motion is not None:
        q, p = np.zeros(scene.n_q), np.array(scene.p)
        for t, row in zip(times, out, strict=True):
            scene.contacts.motion(t, q, q, p, row)
    return out[:, :, 0], out[:, :, 1]


@cache
def forces(scene, times):
    """F(t), the moving frame's included."""
    system, out = scene.system, np.zeros((scene.n_q, 3))
    constant, cosine, sine = system.force.terms(scene.n_q)
    F = []
    for t in times:
        f = constant + cosine * np.cos(system.force.omega * t) + sine * np.sin(system.force.omega * t)
        if system.frame is not None:
            system.frame(t, np.zeros(scene.n_q), np.zeros(scene.n_q), np.array(scene.p), out)
            f = f - system.M @ out[:, 2] - system.C @ out[:, 1] - system.K @ out[:, 0]
        F.append(f)
    return np.array(F)


SCENES = [
    pytest.param(scenes.bouncing_ball(t_end=4.5), 3e-3, id="bouncing ball"),
    pytest.param(scenes.impact_oscillator(t_end=20.0), 7e-3, id="impact oscillator"),
    pytest.param(scenes.cam_follower(t_end=0.5), 1e-4, id="cam-follower"),
    pytest.param(scenes.cam_follower(t_end=0.5, coordinates="absolute"), 1e-4, id="cam-follower, absolute"),
    pytest.param(ball_on_table(0.01, 40.0, 0.3, 0.02, 0.0, 1.0), 1e-4, id="table"),
    pytest.param(three_masses(), 1e-2, id="three masses"),
]


@pytest.mark.parametrize(("scene", "h"), SCENES)
@pytest.mark.parametrize("theta", THETAS)
def test_every_step_balances_momentum_to_rounding(scene, h, theta):
    m, s = motion(scene, h, theta), scene.system
    dt = np.diff(m.t)[:, None]
    F = forces(scene, tuple(m.t))
    q, v, f = (theta * x[1:] + (1 - theta) * x[:-1] for x in (m.q, m.v, F))
    change = np.diff(m.v, axis=0) @ s.M + dt * (v @ s.C + q @ s.K - f)
    p = m.impulse[1:] @ scene.contacts.G
    scale = np.max(np.abs(m.v)) * np.max(np.abs(s.M)) + np.max(np.abs(p)) + np.max(dt * np.abs(f))
    # a step is some ten operations on numbers of this size; the duration of a step, from rounded times, is
    # known to 2e-16 t_end
    rounding = 64 * np.finfo(float).eps * scale + 4e-16 * m.t[-1] * np.max(np.abs(f) + np.abs(q @ s.K))
    np.testing.assert_allclose(change, p, rtol=0, atol=rounding)


@pytest.mark.parametrize(("scene", "h"), SCENES)
@pytest.mark.parametrize("theta", THETAS)
def test_positions_move_with_the_mean_velocity(scene, h, theta):
    m = motion(scene, h, theta)
    moved = np.diff(m.t)[:, None] * (theta * m.v[1:] + (1 - theta) * m.v[:-1])
    rounding = 8 * np.finfo(float).eps * (np.max(np.abs(m.q)) + m.t[-1] * np.max(np.abs(m.v)))
    np.testing.assert_allclose(np.diff(m.q, axis=0), moved, rtol=0, atol=rounding)


@pytest.mark.parametrize(("scene", "h"), SCENES)
@pytest.mark.parametrize("theta", THETAS)
def test_every_step_obeys_the_impact_law_on_its_active_contacts(scene, h, theta):
    m, c = motion(scene, h, theta), scene.contacts
    s, ds = obstacles(scene, tuple(m.t))
    g, u = m.q @ c.G.T + c.offset - s, m.v @ c.G.T - ds
    active = g[:-1] + 0.5 * np.diff(m.t)[:, None] * u[:-1]
    p, w = m.impulse[1:], u[1:] + c.restitution * u[:-1]
    rounding = 1e-13 * max(1.0, np.max(np.abs(u)))
    clear = np.abs(active) > 1e-12  # the predicted gap is known to rounding only
    assert np.all(p >= 0.0)
    assert np.count_nonzero(p) > 1
    assert np.all(p[(active > 0) & clear] == 0.0)
    on = (active <= 0) & clear
    # Where some separate while others strike, blows may follow one another: they leave no approach
    mixed = np.any(on & (u[:-1] > 0.0), axis=1) & np.any(on & (u[:-1] < 0.0), axis=1)
    at_once, later = on & ~mixed[:, None], on & mixed[:, None]
    assert np.all(w[at_once] >= -rounding)
    assert np.all(np.minimum(p, np.abs(w))[at_once] <= rounding)
    free = np.linalg.solve(
        scene.system.M, (forces(scene, tuple(m.t)) - m.v @ scene.system.C - m.q @ scene.system.K).T
    )
    assert np.all(u[1:][later] >= -2.0 * h * np.max(np.abs(free.T @ c.G.T)))


@pytest.mark.parametrize(("scene", "h"), SCENES)
def test_all_impulses_together_are_the_change_of_momentum(scene, h):
    m, s = motion(scene, h), scene.system
    F = forces(scene, tuple(m.t))
    smooth = np.trapezoid(F - m.v @ s.C - m.q @ s.K, m.t, axis=0)
    total = s.M @ (m.v[-1] - m.v[0]) - smooth
    size = np.sum(np.abs(m.impulse)) + np.trapezoid(np.max(np.abs(F), axis=1), m.t)
    np.testing.assert_allclose(
        m.impulse.sum(axis=0) @ scene.contacts.G, total, rtol=0, atol=1e-15 * size * 30
    )


@pytest.mark.parametrize(("scene", "h"), SCENES)
def test_the_log_tells_the_impulse_of_impacts_and_its_velocities(scene, h):
    m, c = motion(scene, h), scene.contacts
    _, du = obstacles(scene, tuple(m.t))
    assert len(m.impacts) > 0
    assert np.all(np.diff(m.impacts.time) >= 0.0)
    for e in m.impacts:
        k = int(np.argmin(np.abs(m.t - e.time)))
        assert m.t[k] == pytest.approx(e.time, rel=1e-15)
        u = [(m.v[i] @ c.G.T - du[i])[e.contact] for i in (k - 1, k)]
        # g_t comes from callbacks, compiled and not, that may round differently
        assert [e.before, e.after] == pytest.approx(u, abs=1e-14 * max(1.0, np.max(np.abs(m.v))))
        assert e.impulse == m.impulse[k, e.contact]


def test_newton_says_how_every_impact_of_a_ball_ends():
    log = simulate(scenes.bouncing_ball(t_end=3.0), Moreau(1e-4, theta=0.5)).impacts
    np.testing.assert_allclose(log.after, -0.8 * log.before, rtol=1e-13)


def test_a_ball_at_rest_on_the_floor_stays_there():
    m = simulate(scenes.bouncing_ball(h0=0.0, t_end=1.0), Moreau(1e-3))
    assert np.all(m.q == 0.0)
    assert np.all(m.v == 0.0)
    np.testing.assert_allclose(m.impulse[1:, 0], 9.81e-3, rtol=1e-12)


@pytest.mark.parametrize("theta", THETAS)
def test_a_plastic_ball_on_a_table_moves_with_it_until_it_is_thrown_off(theta):
    w, A = 40.0, 0.01
    scene = ball_on_table(A, w, 0.0, 0.0, A * w, 0.1)  # on the table, with its velocity
    scene = Scene(system=scene.system, contacts=scene.contacts, q0=0.0, v0=0.0, t_span=(0.0, 0.02), p=[A, w])
    m = simulate(scene, Moreau(1e-5, theta))
    closed = m.t < np.arcsin(9.81 / (A * w * w)) / w - 2e-5
    assert np.all(m.impulse[1:, 0][closed[1:]] > 0.0)
    np.testing.assert_allclose(m.v[1:][closed[1:], 0], A * w * np.cos(w * m.t[1:][closed[1:]]), rtol=1e-12)


def test_relative_and_absolute_coordinates_make_the_same_motion():
    # c'' is averaged over a step in one, and c followed in the other: apart by O(h^2) without impacts, and by O(h)
    # after them, as an impact may fall into another step
    apart = []
    for h in (4e-5, 2e-5, 1e-5, 5e-6):
        runs = [
            simulate(scenes.cam_follower(t_end=0.12, coordinates=c), Moreau(h))
            for c in ("relative", "absolute")
        ]
        lift, _ = obstacles(runs[1].scene, tuple(runs[1].t))
        assert len(runs[0].impacts) == len(runs[1].impacts) >= 2
        apart.append(np.mean(np.abs(runs[0].q + lift - runs[1].q)))
    assert np.all(np.diff(apart) < 0.0) or apart[-1] < 0.3 * apart[0]
    assert apart[-1] < 1e-3
