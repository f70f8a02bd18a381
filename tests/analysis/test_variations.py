"""Derivatives of motions with several contacts: closed forms between events, whatever the unit of length."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.linalg import expm

from lagrangian import Contacts, Coulomb, Harmonic, LinearContacts, LinearSystem, Scene, System
from lcpstep import EventDriven, Kind, simulate
from lcpstep.analysis.variation import factors, monodromy
from tests.differences import jacobian

TIGHT = EventDriven(rtol=1e-12, atol=1e-18)


@pytest.mark.parametrize("unit", [1.0, 1e-6])
def test_a_linear_motion_on_a_wall_between_two_has_the_exponential_of_its_matrix(unit):
    M, C, K = np.diag([1.0, 2.0]), [[0.3, -0.1], [-0.1, 0.2]], [[5.0, -2.0], [-2.0, 4.0]]
    walls = LinearContacts([[0.0, 1.0], [1.0, 0.0]], offset=[0.0, 9.0 * unit])
    system = LinearSystem(M, C, K, force=Harmonic([0.0, -9.0 * unit], cosine=[unit, 0.0], omega=2.0))
    scene = Scene(system, [0.3 * unit, 0.0], [0.1 * unit, 0.0], (0.0, 1.5), walls)
    run = simulate(scene, TIGHT, keep="impacts")
    assert [e.kind for e in run.impacts] in ([], [Kind.STICK])  # the second mass rests all the time
    A = np.block([[np.zeros((2, 2)), np.eye(2)], [-np.linalg.solve(M, K), -np.linalg.solve(M, C)]])
    first = np.diag([1.0, 0.0, 1.0, 0.0])  # what is left with the second mass at rest
    D = np.eye(4)
    for factor in factors(run):
        D = factor @ D
    np.testing.assert_allclose(D, expm(1.5 * first @ A) @ first, rtol=0.0, atol=1e-11)


def hill(t, q, v, p, out):
    out[0], out[1] = q[1] - 0.2 * np.sin(q[0]), 3.0 - q[0]


def its_slope(t, q, v, p, out):
    out[0, 0], out[0, 1], out[1, 0], out[1, 1] = -0.2 * np.cos(q[0]), 1.0, -1.0, 0.0


def along_it(t, q, v, p, out):
    out[0, 0], out[0, 1], out[1, 0], out[1, 1] = 1.0, 0.2 * np.cos(q[0]), 0.0, 1.0


def gravity(t, q, v, p, out):
    out[0], out[1] = 2.0 + np.sin(t) - q[0] ** 2, -9.81


def weaker_with_speed(t, q, v, p, out):
    for c in range(2):
        out[c] = 0.1 + 0.2 / (1.0 + v[c] ** 2)


@pytest.mark.parametrize("mu", [0.0, 0.2, weaker_with_speed])
def test_a_motion_over_a_hill_has_the_derivative_of_differences(mu):
    contacts = Contacts(2, hill, its_slope, restitution=0.5, friction=Coulomb(mu, along_it))
    scene = Scene(System(2, np.eye(2), gravity), [0.1, 0.5], [1.0, 0.0], (0.0, 0.55), contacts)
    kinds = set(simulate(scene, TIGHT, keep="impacts").impacts.kind)
    assert kinds == {Kind.IMPACT}
    x = np.concatenate([scene.q0, scene.v0])
    D = monodromy(scene, TIGHT, x, scene.t_span)

    def end(y):
        run = simulate(
            Scene(scene.system, y[:2], y[2:], scene.t_span, contacts), TIGHT, keep=[scene.t_span[1]]
        )
        return np.concatenate([run.q[-1], run.v[-1]])

    d = 1e-5 * np.eye(4)
    told = np.array([(end(x + e) - end(x - e)) / 2e-5 for e in d]).T
    np.testing.assert_allclose(D, told, rtol=0.0, atol=1e-6 * np.max(np.abs(D)))


def sawtooth(t, q, v, p, out):  # a table that rises with 0.1 m/s for 0.4 s of every second, and falls
    s = t % 1.0
    speed = 0.1 if s < 0.4 else -0.2 / 3.0
    for i in range(out.shape[0]):
        out[i, 0], out[i, 1], out[i, 2] = 0.1 * s if s < 0.4 else (1.0 - s) * 0.2 / 3.0, speed, 0.0


def gap_over_it(t, q, v, p, out):
    s = t % 1.0
    out[0] = q[0] - (0.1 * s if s < 0.4 else (1.0 - s) * 0.2 / 3.0)


def its_rate(t, q, v, p, out):
    out[0] = -0.1 if t % 1.0 < 0.4 else 0.2 / 3.0


def upright(t, q, v, p, out):
    out[0, 0] = 1.0


def pushed(t, q, v, p, out):
    out[0] = -9.81 - 0.3 * q[0] ** 3 - 0.1 * v[0] + (2.0 if t % 1.0 < 0.4 else -2.0)


def on_a_sawtooth(kind):
    """Bodies of one coordinate over it, struck between corners and after them."""
    if kind == "curved":
        return System(1, 1.0, pushed), Contacts(1, gap_over_it, upright, gap_t=its_rate, restitution=0.8)
    force = Harmonic(constant=[-9.81, -8.0])
    system = LinearSystem(M=np.eye(2), C=0.1 * np.eye(2), K=[[3.0, -1.0], [-1.0, 3.0]], force=force)
    if kind == "two":
        return system, LinearContacts(G=np.eye(2), restitution=[0.8, 0.7], motion=sawtooth)
    rubs = Coulomb(0.2, [[0.0, 1.0]])
    return system, LinearContacts(G=[[1.0, 0.0]], restitution=0.8, motion=sawtooth, friction=rubs)


@pytest.mark.parametrize("t_end", [0.9, 1.7])
@pytest.mark.parametrize("kind", ["curved", "two", "rough"])
def test_a_motion_over_corners_of_the_scene_has_the_derivative_of_differences(kind, t_end):
    system, contacts = on_a_sawtooth(kind)
    n = system.n_q
    x, method = np.array([0.5, 0.75, 0.3, -0.4])[[0, 2] if n == 1 else slice(None)], EventDriven(1e-12, 1e-12)
    scene = Scene(system, x[:n], x[n:], (0.0, t_end), contacts=contacts, corners=[0.0, 0.4], period=1.0)
    run = simulate(scene, method)
    assert np.any(run.impacts.time > 0.4)

    def end(y):
        moved = simulate(replace(scene, q0=y[:n], v0=y[n:]), method)
        return np.concatenate([moved.q[-1], moved.v[-1]])

    J = jacobian(end, x, 1e-6)
    assert np.max(np.abs(J)) > 1.0
    assert monodromy(scene, method, x, (0.0, t_end)) == pytest.approx(J, abs=3e-7 * np.max(np.abs(J)))
