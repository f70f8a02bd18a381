"""Contacts that say the same as another one, and slits without room, change no motion beside friction and joints.

The force that two of them share is known as their sum alone; what is held from both sides is held as by a joint.
"""

import numpy as np
import pytest
from scipy.linalg import null_space

from lagrangian import Coulomb, Harmonic, LinearContacts, LinearJoints, LinearSystem, Scene
from lcpstep import EventDriven, Located, Moreau, Status, simulate
from tests.marks import seeds

METHODS = [EventDriven(), Located(1e-3), Located(1e-2, order=4), Located(1e-2, tolerance=1e-6), Moreau(1e-3)]


def drawn(seed, slit):
    """A scene, and the same with a contact said twice, in other units, or with a slit in the place of a joint."""
    rng = np.random.default_rng(seed)
    n = int(rng.integers(3, 6))
    J = np.round(rng.normal(size=(int(rng.integers(1, n - 1)), n)), 3)
    G, T = np.round(rng.normal(size=(2, 1, n)), 3)
    held = np.vstack([J, np.round(rng.normal(size=n), 3)]) if slit else J
    free = null_space(held)
    v0, unit = free @ rng.normal(size=free.shape[1]), float(rng.choice([1.0, 3.7, 1e-2, 50.0]))
    gap, mu, slip = rng.uniform(0.03, 0.2, 1), rng.uniform(0.05, 0.3, 1), 0.3 * rng.normal(size=1)
    system = LinearSystem(
        M=np.diag(10.0 ** rng.uniform(-0.5, 0.5, n)),
        K=np.diag(rng.uniform(0.0, 30.0, n)),
        force=3.0 * rng.normal(size=n) - 2.0 * G[0],
    )

    def scene(joints, rows, tangents, gaps, mus, slips):
        friction = Coulomb(mus, tangents, slip=slips)
        contacts = LinearContacts(rows, offset=gaps, friction=friction)
        return Scene(
            system, q0=np.zeros(n), v0=v0, t_span=(0.0, 0.5), contacts=contacts, joints=LinearJoints(joints)
        )

    once = scene(held, G, T, gap, mu, slip)
    if slit:
        walls, none = np.vstack([held[-1], -unit * held[-1]]), np.zeros(2)
        rows, tangents = np.vstack([G, walls]), np.vstack([T, np.ones((2, n))])
        return once, scene(
            J, rows, tangents, np.append(gap, none), np.append(mu, none), np.append(slip, none)
        )
    units = np.array([1.0, unit])
    return once, scene(
        J, np.outer(units, G[0]), np.outer(units, T[0]), gap * units, np.repeat(mu, 2), slip * units
    )


@pytest.mark.parametrize("numbers", seeds(100, 35))
@pytest.mark.parametrize("slit", [False, True], ids=["twice", "slit"])
@pytest.mark.parametrize("method", METHODS, ids=repr)
def test_they_change_no_motion(method, slit, numbers):
    for seed in numbers:
        once, again = (simulate(scene, method) for scene in drawn(seed, slit))
        if once.status != Status.DONE:  # sliding that jams
            continue
        assert again.status == Status.DONE, (seed, again.message)
        near = 1e-5 if getattr(method, "tolerance", None) else 1e-7
        assert np.max(np.abs(again.q[-1] - once.q[-1])) < near * (0.1 + np.max(np.abs(once.q[-1]))), seed


def test_feet_on_a_line_push_whichever_of_them_the_forces_found_are_of():
    """Seven feet of a board, pressed by a spring, share two normals: forces of three of them are one too many."""
    feet = np.column_stack([np.ones(7), np.round(np.linspace(-0.5, 0.5, 7), 3)])
    board = LinearSystem(
        np.diag([1.0, 0.0924]), K=[[1.01, 2.82], [2.82, 7.91]], force=Harmonic(constant=[-9.81, 0.0])
    )
    ground = LinearContacts(feet, np.zeros(7), restitution=0.25)
    run = simulate(Scene(board, [0.0, 0.0], [1.96, -0.314], (0.0, 1.3699), contacts=ground), EventDriven())
    assert np.min(run.impulse) >= 0.0
    at_rest = np.flatnonzero(run.t > 0.6)
    weight = np.array([9.81, 0.0]) * (run.t[-1] - run.t[at_rest[0] - 1])
    np.testing.assert_allclose(feet.T @ run.impulse[at_rest].sum(axis=0), weight, atol=1e-9)
