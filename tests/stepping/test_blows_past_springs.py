"""A block sticks under a load that only mu_s holds; what strikes elsewhere is tied to it by springs alone."""

import numpy as np
import pytest
from scipy import sparse

from lagrangian import Coulomb, LinearContacts, LinearSystem, Scene
from lcpstep import EventDriven, Moreau, simulate

G, SPRING, LOAD = 9.81, 1.0, 0.6  # of the weight; mu is 0.4, mu_s 0.8


def scene(pairs, made, joined=0.0):
    """Pairs of a block (x, y) on the floor and a mass z that flies against a wall; `joined`: by their mass, too."""
    M = np.eye(3)
    M[0, 2] = M[2, 0] = joined
    K = SPRING * np.array([[1.0, 0.0, -1.0], [0.0, 0.0, 0.0], [-1.0, 0.0, 1.0]])
    one = np.eye(pairs)
    rows, along = np.array([[0.0, 1.0, 0.0], [0.0, 0.0, -1.0]]), np.array([[1.0, 0.0, 0.0], [0.0, 1.0, 0.0]])
    friction = Coulomb(np.tile([0.4, 0.0], pairs), made(np.kron(one, along)), mu_s=np.tile([0.8, 0.0], pairs))
    return Scene(
        LinearSystem(made(np.kron(one, M)), None, made(np.kron(one, K)), np.tile([LOAD * G, -G, 0.0], pairs)),
        np.zeros(3 * pairs), np.tile([0.0, 0.0, 1.0], pairs), (0.0, 0.2),
        LinearContacts(made(np.kron(one, rows)), np.tile([0.0, 0.1], pairs), friction=friction),
    )  # fmt: skip


@pytest.mark.parametrize("h", [1e-2, 1e-3, 1e-4])
def test_a_blow_does_not_loosen_what_springs_alone_tie_to_it(h):
    run = simulate(scene(1, np.asarray), Moreau(h))
    assert run.v[-1, 2] == pytest.approx(0.0, abs=0.2)  # it has struck
    assert np.all(run.q[:, 0] == 0.0)


def stored(M):
    """A sparse matrix that has its zeros written down."""
    rows, columns = np.indices(M.shape).reshape(2, -1)
    return sparse.csr_array((M.ravel(), (rows, columns)), shape=M.shape)


@pytest.mark.parametrize("made", [sparse.csr_array, stored])
def test_nor_by_sparse_steps(made):
    run = simulate(scene(70, made), Moreau(1e-2))
    assert np.all(run.q[:, 0::3] == 0.0)


@pytest.mark.usefixtures("sparse_steps")
def test_a_blow_goes_through_one_block_to_the_one_on_top():
    """The striker z hangs on the mass of block x; block X, held by mu_s alone, rests on it, and is struck with it."""
    M = np.eye(5)  # x, y, X, Y, z
    M[0, 4] = M[4, 0] = -0.5
    normals = np.array([[0.0, 1.0, 0.0, 0.0, 0.0], [0.0, -1.0, 0.0, 1.0, 0.0], [0.0, 0.0, 0.0, 0.0, -1.0]])
    tangents = np.array([[1.0, 0.0, 0.0, 0.0, 0.0], [-1.0, 0.0, 1.0, 0.0, 0.0], [0.0, 1.0, 0.0, 0.0, 0.0]])
    runs = []
    for made in (np.asarray, sparse.csr_array):
        friction = Coulomb([5.0, 0.4, 0.0], made(tangents), mu_s=[5.0, 0.8, 0.0])
        contacts = LinearContacts(made(normals), [0.0, 0.0, 0.1], friction=friction)
        system = LinearSystem(made(M), force=[0.0, -G, 0.6 * G, -G, 0.0])
        start = np.zeros(5), [0.0, 0.0, 0.0, 0.0, 1.0]
        runs.append(simulate(Scene(system, *start, (0.0, 0.2), contacts), Moreau(1e-3)))
    np.testing.assert_allclose(runs[0].q, runs[1].q, rtol=0.0, atol=1e-12)
    assert runs[0].q[-1, 2] - runs[0].q[-1, 0] > 1e-3


@pytest.mark.parametrize(
    ("pairs", "made"), [(1, np.asarray), (70, sparse.csr_array)], ids=["dense", "sparse"]
)
def test_but_what_shares_a_mass_with_it(pairs, made):
    """The block meets the blow with mu, and slides on, as it does from event to event."""
    run, reference = (
        simulate(scene(pairs, made, -0.5), Moreau(1e-4)),
        simulate(scene(1, np.asarray, -0.5), EventDriven()),
    )
    assert abs(reference.q[-1, 0]) > 1e-3
    assert np.max(np.abs(run.q[-1, 0::3] - reference.q[-1, 0])) < 3e-3
