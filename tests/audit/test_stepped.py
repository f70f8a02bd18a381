"""Polynomials between the states of steps are as near to the motion as is told."""

import numpy as np
import pytest

from lagrangian import Harmonic, LinearContacts, LinearSystem, Scene, scenes
from lcpstep import Located, simulate
from lcpstep.audit import stepped
from lcpstep.audit.missed import among
from lcpstep.audit.pieces import Pieces
from lcpstep.audit.polynomials import basis

SHARES = np.linspace(0.0, 1.0, 9)
SHAPES = basis(SHARES, 5)


def apart(run, B):
    """How far polynomials are from the run's own motion within steps, (m, n_q)."""
    times = run.t[:-1, None] + np.diff(run.t)[:, None] * SHARES[1:-1]
    q, _ = run.at(times.ravel())
    found = np.einsum("si,kij->ksj", SHAPES[1:-1], B)
    return np.max(np.abs(found - q.reshape(found.shape)), axis=1)


def hammer(rng, **more):
    """A random damped oscillator under a force that strikes a wall."""
    w = rng.uniform(0.5, 2.0)
    return Scene(
        system=LinearSystem(
            M=1.0, C=rng.uniform(0.0, 0.4), K=w * w,
            force=Harmonic(constant=-0.5, cosine=rng.uniform(1.0, 3.0), sine=1.0, omega=rng.uniform(0.5, 2.0)),
        ),
        contacts=LinearContacts(G=1.0, offset=0.3, restitution=0.8), q0=1.0, v0=0.0, t_span=(0.0, 20.0), **more,
    )  # fmt: skip


@pytest.mark.parametrize("h", [0.02, 0.1, 0.3])
def test_exact_steps_have_a_bound_that_holds_and_is_no_larger_than_it_must_be(h):
    rng, sharpest = np.random.default_rng(3), {False: 0.0, True: 0.0}
    for _ in range(5):
        run = simulate(hammer(rng), Located(h, order="exact"))
        p = Pieces(run)
        struck = among(run.impacts["time"], run.t[1:])
        assert struck.any()
        bound = stepped.bounds(p.m, run.t, run.q, run.v, struck, np.inf)
        a, a_end = stepped.accelerations(p.m, run.t, run.q, run.v, p.cuts)
        rest = np.zeros(len(struck), dtype=bool)
        B = stepped.coefficients(p.m, run.t, run.q, run.v, a, a_end, rest, struck)
        off = apart(run, B)
        assert np.all(off <= bound + 1e-13)
        for kind in (False, True):
            sharpest[kind] = max(sharpest[kind], np.max((off / bound)[struck == kind]))
    assert sharpest[False] > 0.01
    assert sharpest[True] > 0.002


def test_steps_that_are_too_long_for_a_bound_are_made_again(monkeypatch):
    run = simulate(hammer(np.random.default_rng(3)), Located(0.5, order="exact"))
    asked, again = [], stepped.made_again
    monkeypatch.setattr(stepped, "made_again", lambda x: asked.append(x) or again(x))
    p = Pieces(run)
    assert asked
    assert np.max(apart(run, p.motion.B)) < 1e-4


@pytest.mark.parametrize(
    "scene",
    [
        scenes.pendulum_stop(t_end=2.0), scenes.bowl(t_end=1.0), scenes.elastic_gas(t_end=1.0),
        scenes.rocking_block(), scenes.double_pendulum(t_end=1.0), scenes.chattering_table(t_end=1.0),
    ],
    ids=lambda x: x.name,
)  # fmt: skip
def test_steps_of_order_four_are_met_to_what_is_told_of_them_without_being_made_again(scene, monkeypatch):
    run = simulate(scene, Located(1e-3, order=4))
    monkeypatch.setattr(stepped, "made_again", None)
    p = Pieces(run)
    assert scene.n_c == 1 or p.closed.any() == (scene.name == "rocking-block")
    off = apart(run, p.motion.B)
    if scene.n_c == 1:
        off[p.closed[:, 0]] = 0.0  # nothing flies there
    rounding = 2e-15 * (1.0 + np.abs(run.t[1:, None]) * (1.0 + np.max(np.abs(run.v))))
    told = np.broadcast_to(p.problem.error[0], off.shape)
    assert np.all(off <= told + rounding)
    assert np.max(told) < 1e-7


def test_a_force_that_jumps_at_a_corner_is_taken_from_the_side_of_its_step():
    def pull(t, q, v, p, out):
        out[0] = 3.0 if t < 0.5 else -2.0

    scene = Scene(
        system=LinearSystem(M=1.0, K=4.0, force=pull), contacts=LinearContacts(G=1.0, offset=9.0),
        q0=1.0, v0=0.0, t_span=(0.0, 1.0), corners=[0.5],
    )  # fmt: skip
    run = simulate(scene, Located(1e-2, order=4))
    assert 0.5 in run.t
    assert np.max(apart(run, Pieces(run).motion.B)) < 1e-10


def test_a_body_that_rests_on_what_moves_is_as_near_to_it_as_is_told():
    """No force tells how far a polynomial is from a table that the body follows: its closed gap does."""

    def floor_and_ceiling(t, q, v, p, out):
        s, c = 0.01 * np.sin(20.0 * t), 0.01 * np.cos(20.0 * t)
        out[0, 0], out[0, 1], out[0, 2] = s, 20.0 * c, -400.0 * s
        out[1, 0] = out[1, 1] = out[1, 2] = 0.0

    scene = Scene(
        system=LinearSystem(M=1.0, force=Harmonic(constant=-9.81)),
        contacts=LinearContacts(G=[[1.0], [-1.0]], offset=[0.0, 1.0], motion=floor_and_ceiling),
        q0=0.0, v0=0.2, t_span=(0.0, 1.0),
    )  # fmt: skip
    run = simulate(scene, Located(1e-2, order=4))
    p = Pieces(run)
    resting = p.closed[:, 0]
    assert np.mean(resting) > 0.5
    off, told = apart(run, p.motion.B)[resting, 0], p.problem.error[0][resting, 0]
    assert np.max(off) > 1e-8
    assert np.all(off <= told + 1e-14)


def test_exact_steps_in_a_moving_frame_are_known_where_that_rests(monkeypatch):
    run = simulate(scenes.cam_follower(rpm=660.0, t_end=1.0), Located(1e-3, order="exact"))
    monkeypatch.setattr(stepped, "made_again", None)
    p = Pieces(run)
    assert p.motion.absolute
    times = run.t[:-1, None] + np.diff(run.t)[:, None] * SHARES[1:-1]
    c, still = np.zeros((times.size, 1, 3)), np.zeros(1)
    p.m.frame.sample(np.ascontiguousarray(times.ravel()), still, still, c)
    y = run.at(times.ravel())[0][:, 0] + c[:, 0, 0]
    off = np.abs(np.einsum("si,ki->ks", SHAPES[1:-1], p.motion.B[:, :, 0]) - y.reshape(times.shape))
    assert np.all(off <= p.problem.error[0] + 1e-13)
    assert np.max(p.problem.error[0]) < 1e-9


def test_a_frame_whose_speed_jumps_is_not_told_from_one_side():
    def roof(t, q, v, p, out):
        up = t < 0.5
        out[0, 0], out[0, 1], out[0, 2] = 0.1 * (t if up else 1.0 - t), 0.1 if up else -0.1, 0.0

    scene = Scene(
        system=LinearSystem(M=1.0, K=4.0, force=Harmonic(constant=-9.81), frame=roof),
        contacts=LinearContacts(G=1.0, offset=0.3), q0=1.0, v0=0.0, t_span=(0.0, 1.0), corners=[0.5],
    )  # fmt: skip
    run = simulate(scene, Located(1e-2, order="exact"))
    p = Pieces(run)
    assert not p.motion.absolute
    assert not stepped.turns_evenly(p.m, p.cuts)
