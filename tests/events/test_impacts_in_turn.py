"""Impacts of two contacts in turn, at one instant at last, with friction: a light body between wall and heavy one."""

import numpy as np
import pytest

from lagrangian import Coulomb, LinearContacts, LinearSystem, Scene
from lcpstep import EventDriven, Located, simulate
from tests.random_slopes import complaints, draw


def struck(v, M, G, T, mu, r):
    """The velocity after the impact of one contact by Moreau's law: xi = u+ + r u-, p_T = -mu p_N sign(xi_T)."""
    B = np.array([G, T])
    W, xi = B @ np.linalg.solve(M, B.T), (1.0 + r) * B @ v
    p = np.linalg.solve(W, -xi)
    for way in (1.0, -1.0) if abs(p[1]) > mu * p[0] else ():
        tried = -xi[0] / (W[0, 0] - mu * way * W[0, 1]) * np.array([1.0, -mu * way])
        if way * (xi + W @ tried)[1] >= 0.0:
            p = tried
    return v + np.linalg.solve(M, B.T @ p)


@pytest.mark.parametrize("tolerance", [1e-9, 1e-11, 1e-12])
def test_impacts_in_turn_are_summed_when_friction_goes_on_as_it_does(tolerance):
    """Friction that still turned sliding about left 0.3 to 1.1 m/s, by the tolerance, of what the impacts stop."""
    scene = draw(31533)
    contacts, rubbing = scene.contacts, scene.contacts.friction
    run = simulate(scene, EventDriven(tolerance, tolerance), keep=[1.03782, 1.0378288041])
    v = run.v[0]
    for k in range(2400):
        c = (2, 5)[k % 2]
        v = struck(
            v, scene.system.M, contacts.G[c], rubbing.tangent[c], rubbing.mu[c], contacts.restitution[c]
        )
    slips = rubbing.tangent[[2, 5]] @ np.array([v, run.v[1]]).T
    assert slips[:, 1] == pytest.approx(slips[:, 0], abs=2e-4)  # gravity acts for 9e-6 s meanwhile


@pytest.mark.parametrize("seed", [28767, 31533])
def test_impacts_in_turn_end_alike_by_all_methods(seed):
    assert not complaints(seed)


def slower(t, q, u, p, out):
    out[0], out[1] = 0.3 / (1.0 + 0.5 * abs(u[0])), 0.1 / (1.0 + 0.5 * abs(u[1]))


@pytest.mark.parametrize("method", [EventDriven(1e-9, 1e-9), EventDriven(1e-12, 1e-12), Located(1e-2, 4)])
def test_each_impact_has_the_coefficient_of_the_sliding_before_it(method):
    """At one instant, too; no force acts, so that all impacts may as well follow one another by hand."""
    M, r = np.diag([5.0, 5.0, 0.1, 0.1]), 0.5
    G = np.array([[0.0, 0.0, -1.0, 0.0], [-1.0, 0.0, 1.0, 0.0]])
    T = np.array([[0.0, 0.0, 0.0, 1.0], [0.0, -1.0, 0.0, 1.0]])
    contacts = LinearContacts(G, [1.0, 0.0], r, friction=Coulomb(slower, T))
    v = np.array([2.0, 1.0, 0.0, 3.0])
    scene = Scene(LinearSystem(M), [0.0, 0.0, 0.9, 0.0], v, (0.0, 0.6), contacts=contacts)
    run = simulate(scene, method, keep=[0.6])
    for k in range(2000):
        c, mu = (k + 1) % 2, np.empty(2)
        slower(0.0, None, T @ v, None, mu)
        v = struck(v, M, G[c], T[c], mu[c], r) if G[c] @ v < 0.0 else v
    assert run.v[-1] == pytest.approx(v, abs=1e-8)
