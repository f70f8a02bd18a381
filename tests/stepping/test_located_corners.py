"""Located impacts at corners of a scene: obstacles whose velocity jumps, wherever that falls in a step."""

import numpy as np
import pytest

from lagrangian import Contacts, Harmonic, LinearSystem, Scene, System, scenes
from lcpstep import Kind, Located, SimulationError, Status, simulate

TIMES = [0.3, 0.3 + 1e-13, 0.25, 1.0 / 3.0, 0.3141592653589793]
SAMPLES = np.linspace(0.011, 0.989, 89)
SLOW = [pytest.param(order, marks=pytest.mark.slow) for order in (4, "exact")]


@pytest.mark.parametrize("order", [2, *SLOW])
@pytest.mark.parametrize("falling", [0, 1])
@pytest.mark.parametrize("after", [0.5, -0.5])
def test_a_table_whose_velocity_jumps_takes_a_ball_along_drops_it_or_strikes_it(after, falling, order):
    for at in TIMES:
        scene = scenes.jumping_table(at=at, after=after, falling=falling)
        q, v = scene.exact(SAMPLES)
        for h in (0.003, 0.01, 0.05):
            m = simulate(scene, Located(h, order=order), keep=SAMPLES)
            np.testing.assert_allclose(m.q, q, rtol=0, atol=1e-12)
            np.testing.assert_allclose(m.v, v, rtol=0, atol=1e-12)


def table(t, q, v, p, out):
    s = p[1] if t < p[0] else p[2]
    out[0] = q[0] - s * (t - p[0])
    out[1] = q[1] - s * (t - p[0])


def table_rows(t, q, v, p, out):
    out[0, 0] = out[1, 1] = 1.0
    out[0, 1] = out[1, 0] = 0.0


def table_rate(t, q, v, p, out):
    out[0] = out[1] = -p[1] if t < p[0] else -p[2]


def table_bias(t, q, v, p, out):
    out[0] = out[1] = 0.0


def weight(t, q, v, p, out):
    out[0] = -9.81
    out[1] = -2 * 9.81


def test_a_ball_that_rests_and_one_that_arrives_are_struck_by_one_jump():
    # the first ball at rest, the second falling onto the table as it starts to rise
    at, up, r, M = 0.3, 0.5, 0.5, np.diag([1.0, 2.0])
    contacts = Contacts(2, table, table_rows, gap_t=table_rate, bias=table_bias, restitution=r)
    for system in (LinearSystem(M=M, force=Harmonic(constant=[-9.81, -2 * 9.81])), System(2, M, weight)):
        scene = Scene(
            system=system, contacts=contacts, q0=[0.0, 0.5 * 9.81 * at**2], v0=[0.0, 0.0], t_span=(0.0, 0.35),
            p=[at, 0.0, up], corners=[at],
        )  # fmt: skip
        for h in (0.01, 0.007, 0.35):
            hits = simulate(scene, Located(h)).impacts
            hits = hits[hits.kind == Kind.IMPACT]
            np.testing.assert_allclose(hits.time, at, rtol=0, atol=1e-12)
            u = -9.81 * at
            rows = np.stack([hits.before, hits.after, hits.impulse], axis=1)[np.argsort(hits.contact)]
            np.testing.assert_allclose(rows[0], [0.0, 0.0, up], rtol=0, atol=1e-12)
            np.testing.assert_allclose(rows[1], [u, -r * u, 2.0 * (up - (1 + r) * u)], rtol=1e-11)


def mass_that_turns_negative(t, q, v, p, out):
    out[0, 0] = 1.0 if t < 0.5 else -1.0


def push(t, q, v, p, out):
    out[0] = 2.0


@pytest.mark.parametrize("h", [0.1, 0.17])
def test_a_mass_that_fails_at_a_corner_ends_the_run_there(h):
    system = System(n_q=1, mass=mass_that_turns_negative, force=push)
    scene = Scene(system, 0.0, 0.0, (0.0, 1.0), corners=(0.5,))
    with pytest.raises(SimulationError, match=r"positive definite.* at t = 0.5 s") as stopped:
        simulate(scene, Located(h))
    m = stopped.value.trajectory
    assert m.status == Status.NOT_FINITE
    assert m.t[-1] == pytest.approx(0.5, abs=1e-12)
    np.testing.assert_allclose(m.q[:, 0], m.t**2, atol=1e-12)
