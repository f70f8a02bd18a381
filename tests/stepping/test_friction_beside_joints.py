"""Friction at contacts whose normal the joints hold already, and at others beside them.

Such a contact bears nothing, so it has nothing to rub with, and changes no motion.
"""

import numpy as np
import pytest
from scipy import sparse
from scipy.linalg import null_space

from lagrangian import Coulomb, Harmonic, LinearContacts, LinearJoints, LinearSystem, Scene
from lcpstep import EventDriven, Located, Moreau, Status, simulate
from tests.marks import seeds

METHODS = [
    EventDriven(),
    Located(1e-2),
    Located(1e-2, order=4),
    Located(1e-2, tolerance=1e-6),
    Moreau(1e-2),
    Moreau(1e-2, projected=True),
]


def drawn(seed, mu_own, made=np.asarray):
    """The same body on joints, with such a contact and without it."""
    rng = np.random.default_rng(seed)
    n, resting, first = int(rng.integers(3, 6)), rng.random() < 0.35, rng.random() < 0.5
    J = np.round(rng.normal(size=(int(rng.integers(1, n - 1)), n)), 3)
    k = int(rng.integers(1, 3))
    G, T = np.round(rng.normal(size=(2, k, n)), 3)
    own, along = rng.normal(size=len(J)) @ J, rng.normal(size=n)
    if rng.random() < 0.3:  # said twice, too
        J = np.vstack([J, own])
    free = null_space(J)
    v0 = np.zeros(n) if resting else free @ rng.normal(size=free.shape[1])
    gaps = np.zeros(k) if resting else rng.uniform(0.03, 0.2, k)
    mu, slip = rng.uniform(0.05, 0.4, k), rng.normal(size=k) * (rng.random() < 0.3)
    system = LinearSystem(
        M=made(np.diag(10.0 ** rng.uniform(-0.5, 0.5, n))),
        K=made(np.diag(rng.uniform(0.0, 30.0, n))),
        force=Harmonic(3.0 * rng.normal(size=n) - 2.0 * G.sum(0), cosine=rng.normal(size=n), omega=7.0),
    )
    law = str(rng.choice(["moreau", "newton", "stronge"]))
    r = 0.0 if resting else float(rng.choice([0.0, 0.4]))
    place = 0 if first else k
    scenes = []
    for beside in (True, False):

        def put(rows, row, beside=beside):
            return np.insert(rows, place, row, axis=0) if beside else rows

        friction = Coulomb(put(mu, mu_own), made(put(T, along)), slip=put(slip, 0.5 * mu_own), law=law)
        contacts = LinearContacts(made(put(G, own)), offset=put(gaps, 0.0), restitution=r, friction=friction)
        joints = LinearJoints(made(J), np.zeros(len(J)))
        scenes.append(
            Scene(system, q0=np.zeros(n), v0=v0, t_span=(0.0, 0.5), contacts=contacts, joints=joints)
        )
    return *scenes, place


@pytest.mark.parametrize("numbers", seeds(40, 15))
@pytest.mark.parametrize("mu_own", [0.0, 0.6])
@pytest.mark.parametrize("method", METHODS, ids=repr)
def test_a_contact_of_the_joints_changes_nothing(method, mu_own, numbers):
    for seed in numbers:
        *scenes, own = drawn(seed, mu_own)
        beside, alone = (simulate(scene, method) for scene in scenes)
        assert beside.status == alone.status == Status.DONE, (seed, beside.message)
        assert np.max(np.abs(beside.q[-1] - alone.q[-1])) < 1e-6 * (0.1 + np.max(np.abs(alone.q[-1]))), seed
        assert np.min(beside.impulse) > -1e-9, seed
        assert not np.any(beside.impulse[:, own]), seed
        assert not np.any(beside.friction_impulse[:, own]), seed


@pytest.mark.usefixtures("sparse_steps")
@pytest.mark.parametrize("numbers", seeds(20, 8, pytest.mark.slow))
def test_nor_in_sparse_steps(numbers):
    for seed in numbers:
        *scenes, _ = drawn(seed, 0.6, sparse.csr_array)
        beside, alone = (simulate(scene, Moreau(1e-2)) for scene in scenes)
        assert beside.status == alone.status == Status.DONE, (seed, beside.message)
        assert np.max(np.abs(beside.q[-1] - alone.q[-1])) < 1e-6 * (0.1 + np.max(np.abs(alone.q[-1]))), seed


def comes_closer(t, q, v, p, out):
    out[0, 0], out[0, 1], out[0, 2] = 0.1 * t, 0.1, 0.0


@pytest.mark.usefixtures("sparse_steps")
@pytest.mark.parametrize("made", [np.asarray, sparse.csr_array], ids=["dense", "sparse"])
@pytest.mark.parametrize("rough", [True, False])
def test_an_obstacle_that_pushes_against_joints_ends_the_run(made, rough):
    friction = Coulomb(0.3, made(np.array([[0.0, 1.0]]))) if rough else None
    across = made(np.array([[1.0, 0.0]]))
    scene = Scene(
        LinearSystem(made(np.eye(2)), force=np.array([0.0, 1.0])), np.zeros(2), np.zeros(2), (0.0, 0.1),
        LinearContacts(across, motion=comes_closer, friction=friction), LinearJoints(across),
    )  # fmt: skip
    run = simulate(scene, Moreau(1e-2))
    assert run.status == Status.LCP_FAILED
    assert "obstacle of contact 0 closes in" in run.message or "contacts [0]" in run.message


@pytest.mark.parametrize("restitution", [0.0, 0.5])
def test_friction_with_nothing_to_hold_does_not_make_joints_contradict_each_other(restitution):
    """Bodies tied side by side fall on a floor one after another: impulses of friction and joints are rounding."""
    for seed in range(30):
        rng = np.random.default_rng(seed)
        n = rng.integers(3, 6)
        m, y, upright = 10.0 ** rng.uniform(-1, 1, n), rng.uniform(0, 0.03, n), np.eye(n)
        G, T = np.kron(upright, [[0.0, 1.0]]), np.kron(upright, [[1.0, 0.0]])
        scene = Scene(
            LinearSystem(np.diag(np.repeat(m, 2)), force=np.kron(m, [0.0, -9.81])),
            np.kron(y, [0.0, 1.0]), np.zeros(2 * n), (0.0, 0.15),
            LinearContacts(G, restitution=restitution, friction=Coulomb(0.4, T)), LinearJoints(T[:-1] - T[1:]),
        )  # fmt: skip
        run = simulate(scene, Moreau(h=1e-3))
        assert run.status == Status.DONE
        assert np.max(np.abs(run.v[:, ::2])) < 1e-15
