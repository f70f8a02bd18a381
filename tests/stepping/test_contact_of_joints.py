"""A contact whose normal the joints hold already bears nothing, changes nothing, and stops no run.

What is left of its row once the joints are held is rounding, and so would be every force that follows from it.
"""

import numpy as np
import pytest
from scipy import sparse
from scipy.linalg import null_space

from lagrangian import Coulomb, LinearContacts, LinearJoints, LinearSystem, Scene, System
from lcpstep import EventDriven, Located, Moreau, Status, simulate
from tests.marks import seeds

METHODS = [EventDriven(), Located(1e-2), Located(1e-2, order=4), Located(1e-2, tolerance=1e-6), Moreau(1e-2)]


def drawn(seed, resting, kind=np.asarray):
    """The same body on joints with such a contact and without it."""
    rng = np.random.default_rng(seed)
    n = int(rng.integers(2, 6))
    J = np.round(rng.normal(size=(int(rng.integers(1, n)), n)), 3)
    G = np.round(rng.normal(size=(int(rng.integers(1, 4)), n)), 3)
    own = rng.normal(size=len(J)) @ J
    free = null_space(J)
    v0 = np.zeros(n) if resting else free @ rng.normal(size=free.shape[1])
    gaps = np.zeros(len(G)) if resting else rng.uniform(0.05, 0.5, len(G))
    M, f = np.diag(10.0 ** rng.uniform(-1.0, 1.0, n)), rng.normal(size=n)

    def force(t, q, v, p, out):
        for i in range(n):
            out[i] = f[i] - 0.3 * q[i]

    if kind is System:
        system = System(n, M, force)
    else:
        system = LinearSystem(M=kind(M), force=f)
    scenes = []
    for rows, offset in ((np.vstack([own, G]), np.append(0.0, gaps)), (G, gaps)):
        made = np.asarray if kind is System else kind
        scenes.append(
            Scene(
                system,
                q0=np.zeros(n),
                v0=v0,
                t_span=(0.0, 0.5),
                contacts=LinearContacts(made(rows), offset=offset, restitution=0.0 if resting else 0.4),
                joints=LinearJoints(made(J), np.zeros(len(J))),
            )
        )
    return scenes


@pytest.mark.parametrize("resting", [True, False])
@pytest.mark.parametrize("kind", [np.asarray, System], ids=["linear", "general"])
@pytest.mark.parametrize("method", METHODS, ids=repr)
def test_it_changes_nothing(method, kind, resting):
    for seed in range(14):
        beside, alone = (simulate(scene, method) for scene in drawn(seed, resting, kind))
        assert beside.status == alone.status == Status.DONE, (seed, beside.message)
        size = 1e-3 + np.max(np.abs(alone.q[-1]))
        assert np.max(np.abs(beside.q[-1] - alone.q[-1])) < 1e-8 * size, seed
        assert np.min(beside.impulse) > -1e-9


@pytest.mark.usefixtures("sparse_steps")
@pytest.mark.parametrize("numbers", seeds(8, 3))
@pytest.mark.parametrize("resting", [True, False])
def test_nor_in_sparse_steps(resting, numbers):
    for seed in numbers:
        beside, alone = (simulate(s, Moreau(1e-2)) for s in drawn(seed, resting, sparse.csr_array))
        assert beside.status == alone.status == Status.DONE, (seed, beside.message)
        assert np.max(np.abs(beside.q[-1] - alone.q[-1])) < 1e-8, seed


def test_forces_of_the_others_do_not_pull():
    """The event-driven method had given one contact -0.1 N: its forces followed from the rounding of that row."""
    J = np.array([[-1.13, 1.269, -1.655, 1.008], [0.132, -0.201, 0.464, -1.684]])
    G = np.array([[0.677, 0.794, -0.425, 0.331], [0.454, 1.654, 1.052, -0.789]])
    rng = np.random.default_rng(3)
    for _ in range(100):
        scene = Scene(
            LinearSystem(M=np.diag(10.0 ** rng.uniform(-1.0, 1.0, 4)), force=rng.normal(size=4)),
            q0=np.zeros(4),
            v0=np.zeros(4),
            t_span=(0.0, 1.0),
            contacts=LinearContacts(
                np.vstack([rng.normal(size=2) @ J, G]), offset=np.zeros(3), restitution=0.0
            ),
            joints=LinearJoints(J, np.zeros(2)),
        )
        runs = [simulate(scene, method) for method in (EventDriven(), Located(0.1, order=4))]
        assert np.min(runs[0].impulse) >= -1e-12
        assert np.max(np.abs(runs[0].q[-1] - runs[1].q[-1])) < 1e-9


@pytest.mark.parametrize("seed", [5, 9, 12, 42, 54])
def test_light_bodies_beside_heavy_ones_stay_at_rest_on_it(seed):
    """`Located` of order 2 had ended with LCP_FAILED by speeds that are rounding of what joints take in a step."""
    rng = np.random.default_rng(seed)
    J = rng.normal(size=(2, 3))
    G = np.vstack([0.3 * J[1], rng.normal(size=(2, 3))])
    system = LinearSystem(np.diag([146.0, 1.0, 0.04]), force=rng.normal(size=3) * 10.0 ** rng.integers(3))
    beside, alone = (
        Scene(
            system,
            np.zeros(3),
            np.zeros(3),
            (0.0, 1.0),
            LinearContacts(rows, restitution=0.5),
            LinearJoints(J),
        )
        for rows in (G, G[1:])
    )
    run, truth = simulate(beside, Located(1e-2)), simulate(alone, EventDriven())
    assert run.status is Status.DONE
    np.testing.assert_allclose(run.q[-1], truth.q[-1], rtol=1e-9, atol=1e-12)
    np.testing.assert_allclose(run.impulse.sum(axis=0)[0], 0.0, atol=1e-12)


@pytest.mark.parametrize(
    "friction", [None, Coulomb(0.4, [[1.0, 0.0, 0.0], [1.0, 0.0, 0.0]])], ids=["smooth", "rough"]
)
@pytest.mark.parametrize("method", METHODS, ids=repr)
def test_nor_in_whatever_order_bodies_are_linked(method, friction):
    """`Moreau` had ended with LCP_FAILED by a row in which rounding of one joint's share was left."""
    for links in ([[1.0, -1.0, 0.0], [0.0, 1.0, -1.0]], [[0.0, 1.0, -1.0], [1.0, -1.0, 0.0]]):
        scene = Scene(
            LinearSystem(np.eye(3), force=[-1.0, -2.0, -3.0]), np.zeros(3), np.full(3, -2.0 / 3.0), (0.0, 0.5),
            LinearContacts([[0.0, 0.0, 1.0], [1.0, -1.0, 0.0]], restitution=0.5, friction=friction),
            LinearJoints(links),
        )  # fmt: skip
        run = simulate(scene, method)
        assert run.status is Status.DONE, run.message
        assert np.ptp(run.v, axis=1).max() < 1e-12
        np.testing.assert_allclose(run.impulse[:, 1], 0.0, atol=1e-12)


def test_a_wall_that_moves_against_the_joints_ends_the_run():
    def pushed(t, q, v, p, out):
        out[0, 0], out[0, 1], out[0, 2] = 1e-6 * t, 1e-6, 0.0

    scene = Scene(
        LinearSystem(np.eye(2), force=[0.0, 1.0]), [0.0, 0.0], [0.0, 0.0], (0.0, 1.0),
        LinearContacts([[1.0, 0.0]], motion=pushed), LinearJoints([[1.0, 0.0]]),
    )  # fmt: skip
    assert simulate(scene, Located(1e-2)).status is Status.LCP_FAILED
