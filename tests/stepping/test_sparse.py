"""Large sparse systems: the same steps as the dense ones, exact rest, weights, memory, and wrong input."""

import tracemalloc

import numpy as np
import pytest
from scipy import sparse

from lagrangian import Contacts, Harmonic, LinearContacts, LinearSystem, Scene
from lcpstep import EventDriven, LcpStepError, Moreau, SimulationError, simulate
from tests.marks import slow

pytestmark = pytest.mark.usefixtures("sparse_steps")


def chain_gaps(n):
    """Rows of a floor under the first body and of each body on the one before."""
    return sparse.diags_array([np.ones(n), -np.ones(n - 1)], offsets=[0, -1]).tocsr()


def column(n, *, r=0.0, gap=0.0, drop=0.0, stiffness=0.0, damping=0.0, t_end=0.1):
    G = chain_gaps(n)
    K = (G.T @ G).tocsr()
    return Scene(
        system=LinearSystem(sparse.eye_array(n), C=damping * K, K=stiffness * K, force=np.full(n, -9.81)),
        contacts=LinearContacts(G, restitution=r),
        q0=drop + gap * np.arange(1, n + 1), v0=np.zeros(n), t_span=(0.0, t_end), name="column",
    )  # fmt: skip


def shaker(t, q, v, p, out):
    out[:, 0] = 0.02 * np.sin(9.0 * t)
    out[:, 1] = 0.18 * np.cos(9.0 * t)
    out[:, 2] = -1.62 * np.sin(9.0 * t)


def scattered(n, density, rng, values):
    """A sparse matrix with random entries at random places."""
    places = rng.choice(n * n, size=round(density * n * n), replace=False)
    return sparse.coo_array((values(size=len(places)), np.divmod(places, n)), shape=(n, n)).tocsr()


def random_scene(n, seed, bandwidth=None):
    """Masses, springs and dampers at random, driven, among shaking obstacles; any graph, or a banded one."""
    rng = np.random.default_rng(seed)
    B = scattered(n, 2.0 / n, rng, rng.random)
    G = scattered(n, 2.5 / n, rng, rng.standard_normal)
    if bandwidth is not None:
        B, G = (sparse.tril(sparse.triu(x, -bandwidth), bandwidth).tocsr() for x in (B, G))
    G = (G + sparse.eye_array(n)).tocsr()
    M = sparse.diags_array(rng.uniform(0.5, 2.0, n)) + 0.1 * (B @ B.T)
    force = Harmonic(constant=rng.normal(size=n), cosine=5.0 * rng.normal(size=n), omega=7.0)
    return Scene(
        system=LinearSystem(M, C=0.3 * (B @ B.T), K=20.0 * (B.T @ B), force=force),
        contacts=LinearContacts(G, 0.05, rng.uniform(0.0, 0.8, n), motion=shaker),
        q0=np.zeros(n), v0=np.zeros(n), t_span=(0.0, 1.0), name="random",
    )  # fmt: skip


def made_dense(scene):
    """The same scene with arrays."""
    s, c = scene.system, scene.contacts
    return Scene(
        system=LinearSystem(s.M.toarray(), s.C.toarray(), s.K.toarray(), s.force),
        contacts=LinearContacts(c.G.toarray(), c.offset, c.restitution, c.motion),
        q0=scene.q0, v0=scene.v0, t_span=scene.t_span, name=scene.name,
    )  # fmt: skip


SAME = {
    "falling column of 20": column(20, r=0.5, gap=0.02, t_end=0.6),
    "column of 9 thrown as one": column(9, r=0.3, drop=0.05, t_end=0.3),
    "springs and dampers, 50": column(50, r=0.2, gap=0.01, stiffness=100.0, damping=1.0, t_end=0.6),
    "banded, 25": random_scene(25, 1, bandwidth=2),
    "any graph, 5": random_scene(5, 2),
    "any graph, 40": random_scene(40, 3),
}


@pytest.mark.parametrize("theta", [0.5, 1.0])
@pytest.mark.parametrize("name", slow(SAME, longest=["any graph, 40"]))
def test_the_sparse_run_is_the_dense_run(name, theta):
    scene = SAME[name]
    a, b = (simulate(x, Moreau(1.7e-3, theta)) for x in (scene, made_dense(scene)))
    assert a.status.name == b.status.name == "DONE"
    assert a.impulse.max() > 0.0
    size = np.max(np.abs(b.v))
    np.testing.assert_allclose(a.t, b.t, rtol=0, atol=1e-15)
    np.testing.assert_allclose(a.q, b.q, rtol=0, atol=1e-12 * size)
    np.testing.assert_allclose(a.v, b.v, rtol=0, atol=1e-11 * size)
    assert a.counts.steps == b.counts.steps
    if name == "column of 9 thrown as one" or (name, theta) == ("falling column of 20", 1.0):
        return  # whether a contact carries nothing or rounding while it falls decides what the log calls an impact
    strong = [run.impacts[run.impacts.impulse > 1e-9] for run in (a, b)]
    np.testing.assert_array_equal(strong[0].contact, strong[1].contact)
    np.testing.assert_array_equal(strong[0].kind, strong[1].kind)
    np.testing.assert_allclose(strong[0].before, strong[1].before, rtol=0, atol=1e-10 * size)
    np.testing.assert_allclose(strong[0].after, strong[1].after, rtol=0, atol=1e-10 * size)


@pytest.mark.parametrize("keep", [7, np.array([0.0, 0.0123, 0.3, 0.6]), "impacts"], ids=str)
def test_states_are_kept_as_in_the_dense_run(keep):
    scene = SAME["falling column of 20"]
    a, b = (simulate(x, Moreau(1.7e-3), keep=keep) for x in (scene, made_dense(scene)))
    if isinstance(keep, str):  # contacts that carry next to nothing are noted or not
        assert set(np.round(b.t, 9)) <= set(np.round(a.t, 9))
        return
    np.testing.assert_allclose(a.t, b.t, rtol=0, atol=1e-15)
    np.testing.assert_allclose(a.q, b.q, rtol=0, atol=1e-13)
    np.testing.assert_allclose(a.impulse, b.impulse, rtol=0, atol=1e-12)


def test_a_column_of_a_thousand_carries_the_weight_above_each_contact():
    n, h = 1000, 1e-3
    m = simulate(column(n, r=0.5, t_end=0.01), Moreau(h))
    np.testing.assert_allclose(m.impulse[1:] / h, np.tile(9.81 * np.arange(n, 0, -1), (10, 1)), rtol=1e-12)


@pytest.mark.parametrize("theta", slow([0.5, 1.0], longest=[1.0]))
def test_what_rests_stays_exactly_where_it_is(theta):
    m = simulate(column(12, r=0.5, t_end=2.0), Moreau(1e-3, theta), keep=100)
    assert m.counts.steps == 2000  # each of which begins as the one before
    assert not m.q.any()
    assert not m.v.any()


@pytest.mark.slow
def test_a_fallen_column_comes_to_exact_rest():
    n = 60
    m = simulate(column(n, r=0.5, gap=0.01, t_end=2.0), Moreau(1e-3), keep=100)
    assert not m.v[-3:].any()
    np.testing.assert_array_equal(m.q[-1], m.q[-2])
    np.testing.assert_allclose(m.impulse[-1] / 0.1, 9.81 * np.arange(n, 0, -1), rtol=1e-12)


def test_mass_ratios_cost_no_digits():
    # a block of 1e9 kg on one of 1 kg: the forces are known
    heavy = np.array([1.0, 1e9])
    scene = Scene(
        LinearSystem(sparse.diags_array(heavy), force=-9.81 * heavy), [0.0, 0.0], [0.0, 0.0], (0.0, 0.01),
        LinearContacts(chain_gaps(2)),
    )  # fmt: skip
    m = simulate(scene, Moreau(1e-3))
    np.testing.assert_allclose(m.impulse[-1] / 1e-3, [9.81 * (1e9 + 1.0), 9.81e9], rtol=1e-14)
    assert not m.v.any()


@pytest.mark.slow
def test_an_elastic_chain_bounces_off_a_wall_and_keeps_its_energy():
    # theta = 1/2: only the front, which strikes with e = 0, loses what the work of its impulses says
    n = 400
    G = chain_gaps(n)
    D = (sparse.eye_array(n) - sparse.eye_array(n, k=-1)).tocsr()[1:]
    K = n * (D.T @ D)
    scene = Scene(
        LinearSystem(sparse.eye_array(n) / n, K=K), np.zeros(n) + 0.01, -np.ones(n), (0.0, 4.0),
        LinearContacts(G[:1]),
    )  # fmt: skip
    m = simulate(scene, Moreau(1e-3), keep=10)
    energy = 0.5 * np.sum(m.v**2, axis=1) / n + 0.5 * np.einsum("ij,ij->i", m.q, (K @ m.q.T).T)
    impacts = m.impacts
    lost = -0.5 * np.sum(impacts.impulse * (impacts.before + impacts.after))
    assert energy[0] - energy[-1] == pytest.approx(lost, rel=1e-9)
    assert 0.0 < lost < 0.02  # of 1/2
    # a wave at unit speed runs through the chain, of length one, and back; the force is density times v = 1
    held = np.flatnonzero(m.impulse[:, 0] > 0.0)
    assert m.t[held[-1]] - m.t[held[0]] == pytest.approx(2.0, abs=0.06)
    middle = (m.t > 0.5) & (m.t < 1.5)
    np.testing.assert_allclose(m.impulse[middle, 0] / 0.01, 1.0, rtol=0, atol=0.02)
    assert np.mean(m.v[-1]) == pytest.approx(1.0, abs=0.1)


def test_memory_grows_with_the_number_of_bodies_and_not_with_its_square():
    peaks = []
    for n in (2500, 10_000):
        simulate(column(10, t_end=1e-3), Moreau(1e-3))  # what is loaded once does not count
        scene = column(n, drop=1e-3, t_end=0.04)
        tracemalloc.start()
        m = simulate(scene, Moreau(4e-3), keep="impacts")
        peaks.append(tracemalloc.get_traced_memory()[1])
        tracemalloc.stop()
        assert m.status.name == "DONE"
    assert peaks[1] < 5.0 * peaks[0]
    assert peaks[1] < 100e6  # a dense matrix of this size: 800 MB


def test_free_motion_of_a_sparse_system():
    n = 30
    scene = Scene(
        LinearSystem(sparse.eye_array(n), K=sparse.eye_array(n)), np.ones(n), np.zeros(n), (0.0, 1.0)
    )
    m = simulate(scene, Moreau(1e-3))
    np.testing.assert_allclose(m.q[-1], np.cos(1.0), rtol=0, atol=1e-6)
    assert m.impulse.shape == (1001, 0)


# --- wrong input

EYE = sparse.eye_array(3).tocsr()
CHAIN = chain_gaps(3)


@pytest.mark.parametrize(
    ("arguments", "named"),
    [
        (
            {"M": sparse.csr_array([[1.0, 2.0], [0.0, 1.0]])},
            "M: the mass matrix must be symmetric, but entry",
        ),
        ({"M": sparse.csr_array([[1.0, 2.0], [2.0, 1.0]])}, "M: the mass matrix must be positive definite"),
        ({"M": (CHAIN[1:].T @ CHAIN[1:])}, "M: the mass matrix must be positive definite"),
        ({"M": sparse.diags_array([1.0, 0.0])}, r"M: .* entry \(1, 1\) of its diagonal is 0"),
        ({"M": EYE * np.nan}, "M: expected finite numbers, got nan in row 0, column 0"),
        ({"M": EYE[:2]}, r"M: expected shape \(2, 2\), got \(2, 3\)"),
        ({"M": EYE, "K": EYE[:2]}, r"K: expected shape \(3, 3\), got \(2, 3\)"),
        ({"M": EYE, "C": np.eye(2)}, r"C: expected shape \(3, 3\), got \(2, 2\)"),
        ({"M": EYE * 1j}, "M: expected a matrix of real numbers"),
        ({"M": EYE, "K": np.inf * EYE}, "K: expected finite numbers"),
    ],
)
def test_a_wrong_matrix_is_named(arguments, named):
    with pytest.raises(ValueError, match=named):
        LinearSystem(**arguments)


def test_wrong_contacts_are_named():
    with pytest.raises(ValueError, match="G: expected finite numbers"):
        LinearContacts(CHAIN * np.nan)
    with pytest.raises(
        ValueError, match=r"contacts.G: expected 3 columns, one per coordinate, got shape \(4, 4\)"
    ):
        Scene(LinearSystem(EYE), np.zeros(3), np.zeros(3), (0.0, 1.0), LinearContacts(chain_gaps(4)))
    with pytest.raises(ValueError, match="the gap of contact 0 is -1 m"):
        Scene(LinearSystem(EYE), -np.ones(3), np.zeros(3), (0.0, 1.0), LinearContacts(CHAIN))


def test_nearly_singular_masses_of_any_unit_pass():
    K = CHAIN.T @ CHAIN
    for unit in (1e-30, 1.0, 1e30):
        assert LinearSystem(unit * (K + 1e-8 * EYE)).sparse


def test_what_works_with_dense_matrices_says_so():
    system, contacts = column(3000).system, LinearContacts(sparse.eye_array(1, 3000))
    large = Scene(system, np.ones(3000), np.zeros(3000), (0.0, 1.0), contacts)
    with pytest.raises(LcpStepError, match="M: a method by dense matrices"):
        simulate(large, EventDriven())
    with pytest.raises(
        LcpStepError, match="lcp: Moreau with more than 2000 sparse coordinates does not treat ano"
    ):
        simulate(large, Moreau(1e-3, lcp="qp"))


def test_walls_that_close_on_a_body_have_no_solution_and_say_where():
    def closing(t, q, v, p, out):
        out[:, 0] = t
        out[:, 1] = 1.0
        out[:, 2] = 0.0

    scene = Scene(
        LinearSystem(sparse.eye_array(1)), [0.5], [0.0], (0.0, 1.0),
        LinearContacts(sparse.csr_array([[1.0], [-1.0]]), [0.0, 1.0], motion=closing),
    )  # fmt: skip
    m = simulate(scene, Moreau(1e-2))
    assert m.status.name == "LCP_FAILED"
    assert m.t[-1] == pytest.approx(0.5, abs=0.03)
    assert "contacts [0, 1]" in m.message
    assert np.isfinite(m.q).all()


def test_a_force_that_is_not_finite_ends_the_run_with_what_was_computed():
    def force(t, q, v, p, out):
        out[:] = -1.0
        if t > 0.05:
            out[2] = np.nan

    scene = Scene(LinearSystem(EYE, force=force), np.ones(3), np.zeros(3), (0.0, 1.0), LinearContacts(CHAIN))
    with pytest.raises(SimulationError, match=r"system\.force") as stopped:
        simulate(scene, Moreau(1e-3))
    m = stopped.value.trajectory
    assert m.t[-1] == pytest.approx(0.05)
    assert np.isfinite(m.q).all()


def test_a_curved_contact_of_a_sparse_system_takes_the_dense_steps():
    def gap(t, q, v, p, out):
        out[0] = q[0]

    def jacobian(t, q, v, p, out):
        out[:] = 0.0
        out[0, 0] = 1.0

    ball = LinearSystem(EYE, force=[-9.81, 0.0, 0.0])
    flat = Scene(ball, np.ones(3), np.zeros(3), (0.0, 1.0), LinearContacts(sparse.eye_array(1, 3)))
    curved = Scene(ball, np.ones(3), np.zeros(3), (0.0, 1.0), Contacts(1, gap, jacobian))
    a, b = (simulate(x, Moreau(1e-3)) for x in (flat, curved))
    np.testing.assert_allclose(a.q, b.q, rtol=0, atol=1e-13)


@pytest.mark.parametrize(("n", "decades"), [(300, 5.0), (1000, 4.0), (2000, 4.0)])
def test_columns_of_ever_heavier_bodies_rest_on_the_lightest(n, decades):
    """A proximal step leaves a fifth or a quarter of the error here: there are as many as that takes."""
    m = np.logspace(-decades, decades, n)
    G = sparse.diags_array([np.ones(n), -np.ones(n - 1)], offsets=[0, -1])
    contacts = LinearContacts(G, restitution=0.5)
    scene = Scene(
        LinearSystem(sparse.diags_array(m), force=-9.81 * m), np.zeros(n), np.zeros(n), (0.0, 0.02), contacts
    )
    run = simulate(scene, Moreau(h=1e-3))
    weights = 9.81e-3 * np.cumsum(m[::-1])[::-1]
    assert run.status.name == "DONE"
    assert np.max(np.abs(run.impulse[1:] / weights - 1.0)) < 1e-12
    assert np.max(np.abs(run.v)) < 1e-15
    assert np.max(run.penetration) < 1e-18
