"""Impulses, the contact force's included, balance the momentum row by row."""

import numpy as np
import pytest

from lagrangian import Coulomb, Harmonic, LinearContacts, LinearSystem, Scene, scenes
from lcpstep import EventDriven, simulate
from lcpstep.trajectory import Kind
from tests.models import GRAVITY, ball_on_table, bowl_scene

NODES, WEIGHTS = np.polynomial.legendre.leggauss(12)


def imbalance(m):
    """m dv - integral of (F - C v - K q) - impulses, over each row, of one linear coordinate."""
    s, out = m.scene.system, np.zeros((1, 3))
    h = np.diff(m.t)
    times = (m.t[:-1, None] + 0.5 * h[:, None] * (1 + NODES)).ravel()
    q, v = (x[:, 0] for x in m.at(times))
    shift = np.zeros((2, len(times)))
    ends = np.zeros(len(m.t))
    if s.frame is not None:  # from coordinates relative to the frame to absolute ones
        for k, t in enumerate(times):
            s.frame(t, q, v, np.array(m.scene.p), out)
            shift[:, k] = out[0, :2]
        for k, t in enumerate(m.t):
            s.frame(t, q, v, np.array(m.scene.p), out)
            ends[k] = out[0, 1]
    constant, cosine, sine = (float(x[0]) for x in s.force.terms(1))
    F = constant + cosine * np.cos(s.force.omega * times) + sine * np.sin(s.force.omega * times)
    f = F - s.C[0, 0] * (v + shift[1]) - s.K[0, 0] * (q + shift[0])
    smooth = 0.5 * h * (f.reshape(len(h), -1) @ WEIGHTS)
    return s.M[0, 0] * np.diff(m.v[:, 0] + ends) - smooth - m.scene.contacts.G[0, 0] * m.impulse[1:, 0]


SCENES = [
    # (scene, size of momenta): the tolerances of the runs are 1e-12
    pytest.param(scenes.bouncing_ball(t_end=5.0), 5.0, id="bouncing ball"),
    pytest.param(scenes.bouncing_ball(restitution=0.0, t_end=1.0), 5.0, id="plastic ball"),
    pytest.param(ball_on_table(0.01, 40.0, 0.3, 0.02, 0.0, 1.0), 1.0, id="table"),
    pytest.param(scenes.impact_oscillator(t_end=50.0), 1.0, id="oscillator"),
    pytest.param(
        scenes.impact_oscillator(omega=0.25, amplitude=2.0, stop=0.5, restitution=0.6, t_end=60.0),
        2.0,
        id="sticking oscillator",
    ),
    pytest.param(scenes.cam_follower(t_end=0.5), 30.0, id="cam-follower"),
    pytest.param(scenes.cam_follower(rpm=100.0, q0=0.0, v0=0.0, t_end=1.0), 30.0, id="cam-follower, closed"),
    pytest.param(
        scenes.cam_follower(rpm=150.0, q0=1e-3, v0=0.0, t_end=0.8, coordinates="absolute"),
        30.0,
        id="slow cam",
    ),
]


@pytest.mark.parametrize(("scene", "size"), SCENES)
def test_every_row_balances_momentum(scene, size):
    m = simulate(scene, EventDriven())
    # rows of contact that a corner cuts are integrated by the test less well than by the library
    np.testing.assert_allclose(imbalance(m), 0.0, rtol=0, atol=1e-11 * size)


@pytest.mark.parametrize(("scene", "size"), SCENES)
@pytest.mark.parametrize("keep", [10, "impacts", [0.01, 0.1, 0.3]])
def test_the_impulses_between_kept_rows_are_those_of_all_rows_between_them(scene, size, keep):
    full, part = simulate(scene, EventDriven()), simulate(scene, EventDriven(), keep=keep)
    if isinstance(keep, list):
        total = simulate(scene, EventDriven(), keep=[*keep, scene.t_span[1]]).impulse.sum()
        assert total == pytest.approx(full.impulse.sum(), rel=1e-12, abs=1e-11 * size)
        part = simulate(scene, EventDriven(), keep=[scene.t_span[1]])
        assert part.impulse[0, 0] == pytest.approx(full.impulse.sum(), rel=1e-12, abs=1e-11 * size)
        return
    sums = np.cumsum(full.impulse[:, 0])
    # after an event at the start, or at a kept time, the last row of that time
    rows = np.searchsorted(full.t, part.t, side="right") - 1
    np.testing.assert_allclose(np.cumsum(part.impulse[:, 0]), sums[rows], rtol=1e-12, atol=1e-11 * size)


def test_the_log_holds_the_impulse_of_every_impact():
    m = simulate(scenes.cam_follower(t_end=1.0), EventDriven())
    e = m.impacts
    np.testing.assert_allclose(e.impulse, 1.221 * (e.after - e.before), rtol=1e-14)
    np.testing.assert_allclose(e.after, -0.8 * e.before, rtol=1e-15)


def test_an_accumulation_carries_the_impulse_of_the_impacts_that_it_stands_for():
    # momentum between the last impact told one by one and the rest that follows
    m = simulate(scenes.bouncing_ball(t_end=5.0), EventDriven())
    e = m.impacts[m.impacts.kind == Kind.ACCUMULATION][0]
    last = m.impacts[m.impacts.kind == Kind.IMPACT][-1]
    assert e.impulse == pytest.approx(GRAVITY * (e.time - last.time) - last.after, rel=1e-9)


def test_a_resting_ball_presses_with_its_weight():
    scene = scenes.bouncing_ball(h0=0.0, t_end=2.0)
    assert isinstance(scene.system, LinearSystem)
    m = simulate(scene, EventDriven())
    np.testing.assert_allclose(m.impulse[1:, 0], GRAVITY * np.diff(m.t), rtol=1e-13)


def test_a_point_in_a_bowl_balances_its_momentum():
    m = simulate(bowl_scene([0.5, 0.0], [0.0, 0.0], 4.0), EventDriven())
    # along the vertical: p G_y is the integral of lambda G_y, which the test cannot form from p alone; at the
    # landing it can
    e = m.impacts[0]
    k = int(np.searchsorted(m.t, e.time))
    q, before = m.q[k], np.array([0.0, -e.time])
    np.testing.assert_allclose(m.v[k] - before, -q / np.hypot(*q) * e.impulse, rtol=0, atol=1e-11)


@pytest.mark.parametrize("tolerance", [1e-6, 1e-8])
def test_dependent_contacts_at_rest_only_push(tolerance):
    """What the end of a chattering takes on account is paid by those that bear the force, whoever had the impulse."""
    G = [[0.272, 0.0948, 0.958], [-0.253, 0.725, 0.64], [-0.437, -0.152, 0.886], [0.318, -0.914, 0.252]]
    m = np.array([0.532, 0.937, 0.749])
    w, t = 1.98, 7.0
    constant, cosine, sine = np.array([[0.0, 0.0, -7.35], [0.779, 3.2, 2.94], [1.45, 0.534, -0.432]])
    scene = Scene(
        system=LinearSystem(M=np.diag(m), force=Harmonic(constant=constant, cosine=cosine, sine=sine, omega=w)),
        contacts=LinearContacts(G=G, restitution=0.042), q0=np.zeros(3), v0=np.zeros(3), t_span=(0.0, t),
    )  # fmt: skip
    motion = simulate(scene, EventDriven(tolerance, tolerance))
    pushed = constant * t + cosine * np.sin(w * t) / w + sine * (1.0 - np.cos(w * t)) / w
    assert np.min(motion.impulse) >= 0.0
    borne = np.array(G).T @ motion.impulse.sum(axis=0)
    assert pushed + borne == pytest.approx(m * motion.v[-1], abs=100.0 * tolerance)


@pytest.mark.parametrize("rows", [2, 50, 3000])
@pytest.mark.parametrize("friction", [None, Coulomb(0.0, np.eye(2))], ids=["by parabolas", "by steps"])
def test_the_end_of_chattering_is_paid_for_however_short_the_rows_are(friction, rows):
    """Hops that a loose tolerance leaves out: the force pays for the impulse that takes their speed, row by row."""
    G, force = np.array([[1.0, 0.0], [0.8, 0.6]]), np.array([-81.0, -60.0])
    contacts = LinearContacts(G, restitution=(0.0, 0.05), friction=friction)
    scene = Scene(LinearSystem(np.eye(2), force=tuple(force)), (0.0, 0.0), (0.0, 0.05), (0.0, 0.2), contacts)
    m = simulate(scene, EventDriven(1e-3, 1e-3), keep=np.linspace(0.0, 0.2, rows))
    np.testing.assert_allclose(m.v[-1], 0.0, rtol=0, atol=1e-12)
    np.testing.assert_allclose(m.impulse.sum(0) @ G, -m.scene.v0 - 0.2 * force, rtol=1e-12, atol=0)
    assert np.min(m.impulse) >= 0.0
