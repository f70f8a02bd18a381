"""Large sparse systems with joints and friction: the dense steps, closed forms, energy, and what has no answer."""

import math
from dataclasses import replace

import numpy as np
import pytest
from scipy import sparse

from lagrangian import Coulomb, Harmonic, Joints, LinearContacts, LinearJoints, LinearSystem, Scene, scenes
from lcpstep import Moreau, SimulationError, energy, simulate
from lcpstep.stepping.sparse.coupled import CoupledRun
from lcpstep.trajectory import Status
from tests.marks import slow

pytestmark = pytest.mark.usefixtures("sparse_steps")


def made_dense(s):
    """The same scene with arrays."""
    c, joints = s.contacts, s.joints
    f = c.friction
    if isinstance(joints, Joints):
        joints = Joints(s.n_j, joints.gap, joints.as_contacts().jacobian, bias=joints.bias)
    elif joints is not None:
        joints = LinearJoints(joints.G.toarray(), joints.offset, joints.motion)
    friction = None if f is None else Coulomb(f.mu, f.tangent.toarray(), f.slip, f.restitution, f.mu_s, f.law)
    return Scene(
        system=LinearSystem(s.system.M.toarray(), s.system.C.toarray(), s.system.K.toarray(), s.system.force),
        contacts=LinearContacts(c.G.toarray(), c.offset, c.restitution, c.motion, friction),
        joints=joints, q0=s.q0, v0=s.v0, t_span=s.t_span, p=s.p, name=s.name,
    )  # fmt: skip


def coupled_masses(seed, friction=True, joints=True):
    """Points in a plane on springs and dampers, tied by constant joints, some of them twice, thrown at a floor."""
    rng, n = np.random.default_rng(seed), 12
    B = sparse.random_array((2 * n, 2 * n), density=0.06, rng=rng)
    up, along = (
        sparse.csr_array((np.ones(n), (np.arange(n), 2 * np.arange(n) + i)), shape=(n, 2 * n)) for i in (1, 0)
    )
    J = sparse.lil_array((3, 2 * n))
    J[0, 0], J[0, 2], J[1, 6], J[1, 10], J[2, 0], J[2, 2] = 1.0, -1.0, 1.0, -1.0, 2.0, -2.0
    M = sparse.diags_array(rng.uniform(0.5, 2.0, 2 * n)) + 0.05 * (B @ B.T)
    return Scene(
        system=LinearSystem(M, C=0.2 * (B @ B.T), K=30.0 * (B.T @ B), force=np.tile([1.0, -9.81], n)),
        contacts=LinearContacts(up, 0.05, 0.3, friction=Coulomb(0.4, along) if friction else None),
        joints=LinearJoints(J.tocsr()) if joints else None, q0=np.zeros(2 * n), v0=np.tile([0.4, 0.0], n),
        t_span=(0.0, 0.6), name="coupled masses",
    )  # fmt: skip


def falling(t, q, u, p, out):
    """Stribeck's coefficient: 0.6 at rest, 0.2 far from it."""
    for c in range(len(out)):
        out[c] = 0.2 + 0.4 * math.exp(-abs(u[c]) / 0.2)


def swaying(n):
    """Belts that run to and fro."""
    return Harmonic(np.full(n, -0.1), np.full(n, 0.3), np.full(n, 0.2), 9.0)


def rubbing(s, mu=0.2, **friction):
    """The scene with another friction."""
    c = s.contacts
    contacts = LinearContacts(
        c.G, c.offset, c.restitution, c.motion, Coulomb(mu, c.friction.tangent, **friction)
    )
    return replace(s, contacts=contacts)


SAME = {
    "chain of 5": (scenes.hinged_chain(n=5, t_end=0.4), 0.5),
    "chain of 5, thrown up": (scenes.hinged_chain(n=5, restitution=0.3, t_end=0.4), 1.0),
    "chain of 40": (scenes.hinged_chain(n=40, t_end=0.2), 0.5),
    "chain of 20, smooth": (scenes.hinged_chain(n=20, mu=0.0, t_end=0.4), 0.5),
    "joints and friction": (coupled_masses(1), 0.5),
    "friction": (coupled_masses(2, joints=False), 0.5),
    "joints": (coupled_masses(3, friction=False), 1.0),
    "what sticks has more": (rubbing(coupled_masses(2, joints=False), mu_s=0.5), 0.5),
    "what sticks has more, slides without": (rubbing(coupled_masses(1), 0.0, mu_s=0.5), 0.5),
    "masses on swaying belts": (rubbing(coupled_masses(2, joints=False), mu_s=0.5, slip=swaying(12)), 0.5),
    "chain, Stribeck": (rubbing(scenes.hinged_chain(n=5, t_end=0.4), falling), 1.0),
    "masses, Stribeck and Newton": (rubbing(coupled_masses(1), falling, mu_s=0.9, law="newton"), 0.5),
}  # fmt: skip


LONG = (
    "what sticks has more",
    "chain of 5, thrown up",
    "chain, Stribeck",
    "what sticks has more, slides without",
    "masses on swaying belts",
    "masses, Stribeck and Newton",
)  # of these


@pytest.mark.parametrize(
    "name", slow(SAME, *LONG, longest=["chain of 5", "chain of 40", "chain of 20, smooth"])
)
def test_the_sparse_run_is_the_dense_run(name):
    scene, theta = SAME[name]
    a, b = (simulate(x, Moreau(2e-3, theta)) for x in (scene, made_dense(scene)))
    assert a.status.name == b.status.name == "DONE"
    assert a.impulse.max() > 0.0
    size = np.max(np.abs(b.v))
    np.testing.assert_allclose(a.q, b.q, rtol=0, atol=1e-10 * size)
    np.testing.assert_allclose(a.v, b.v, rtol=0, atol=1e-9 * size)
    assert a.friction_impulse.shape == b.friction_impulse.shape
    assert a.joint_impulse.shape == b.joint_impulse.shape
    np.testing.assert_allclose(a.joint_drift, b.joint_drift, rtol=0, atol=1e-10)


def thousand_blocks(**friction):
    """A thousand blocks on a belt, each on a spring of its own."""
    n = 1000
    rows = np.arange(n)
    up, along = (sparse.csr_array((np.ones(n), (rows, 2 * rows + i)), shape=(n, 2 * n)) for i in (1, 0))
    return Scene(
        system=LinearSystem(sparse.eye_array(2 * n), K=sparse.diags_array(np.tile([1.0, 0.0], n)),
                            force=Harmonic(constant=np.tile([0.0, -1.0], n))),
        contacts=LinearContacts(up, friction=Coulomb(0.6, along, slip=-0.2, **friction)),
        q0=np.zeros(2 * n), v0=np.tile([0.2, 0.0], n), t_span=(0.0, 8.0),
    )  # fmt: skip


@pytest.mark.slow
def test_a_thousand_blocks_on_a_belt_stick_and_slip_as_one_does():
    """Carried to x = mu_s, round an arc of a circle, and carried again: `scenes.stick_slip_belt`."""
    exact = scenes.stick_slip_belt(belt=0.2, mu=0.6, mu_s=1.0).exact
    t = np.linspace(0.5, 8.0, 16)
    run = simulate(thousand_blocks(mu_s=1.0), Moreau(0.01), keep=t)
    assert run.status == Status.DONE
    q = exact(t)[0][:, :1]
    assert np.ptp(q) > 0.8
    assert np.max(np.abs(run.q[:, ::2] - q)) < 0.02
    assert np.ptp(run.q[:, ::2], axis=1).max() < 1e-12


@pytest.mark.slow
def test_a_coefficient_that_is_none_is_named():
    def wrong(t, q, u, p, out):
        for c in range(len(out)):
            out[c] = 0.3 - 0.5 * t

    scene = rubbing(coupled_masses(2, joints=False), wrong)
    with pytest.raises(
        SimulationError, match=r"friction.mu: expected coefficients >= 0, got -0.\d+ of contact"
    ):
        simulate(replace(scene, t_span=(0.0, 0.9)), Moreau(1e-3))


@pytest.mark.slow
def test_impulses_that_are_unique_are_those_of_the_dense_run():
    scene = coupled_masses(2, joints=False)
    a, b = (simulate(x, Moreau(1e-3)) for x in (scene, made_dense(scene)))
    np.testing.assert_allclose(a.impulse, b.impulse, rtol=0, atol=1e-9)
    np.testing.assert_allclose(a.friction_impulse, b.friction_impulse, rtol=0, atol=1e-9)


@pytest.mark.thorough
@pytest.mark.parametrize("restitution", [0.0, 0.4])
def test_energy_is_lost_and_never_created(restitution):
    chain = scenes.hinged_chain(n=30, restitution=restitution, t_end=0.25)
    run = simulate(chain, Moreau(5e-4))
    balance = energy(run)
    assert run.status.name == "DONE"
    steps = np.diff(balance.total)
    assert steps.max() < 1e-5 * balance.total[0]  # what the joints' rows at the end of a step may give
    assert balance.total[-1] < balance.total[0]
    assert len(balance.created) == 0


@pytest.mark.slow
def test_friction_stays_within_its_cone_and_a_flat_chain_comes_to_exact_rest():
    run = simulate(scenes.hinged_chain(n=10), Moreau(1e-3))
    assert np.all(np.abs(run.friction_impulse) <= 0.3 * run.impulse + 1e-12)
    assert np.all(run.impulse >= 0.0)
    assert not run.v[-1].any()
    np.testing.assert_array_equal(run.q[-1], run.q[-50])
    assert run.impulse[-1].sum() == pytest.approx(10 * 9.81 * 1e-3, rel=1e-9)


@pytest.mark.slow
def test_a_free_chain_keeps_its_momentum_and_its_links_their_lengths_to_order_two():
    drift = []
    for h in (4e-3, 2e-3):
        run = simulate(scenes.hinged_chain(n=100, height=5.0, t_end=0.2), Moreau(h))
        P = run.scene.system.M @ run.v[-1]
        assert P[::2].sum() == pytest.approx(100 * 0.5, rel=1e-12)
        assert P[1::2].sum() == pytest.approx(-100 * 9.81 * 0.2, rel=1e-12)
        drift.append(np.max(run.joint_drift))
    assert max(drift) < 1e-12  # it falls without turning


@pytest.mark.slow
def test_a_pendulum_of_one_sparse_link_swings_with_the_energy_it_has():
    def gap(t, q, v, p, out):
        out[0] = 0.5 * (q[0] * q[0] + q[1] * q[1] - 1.0)

    def entries(t, q, v, p, out):
        out[0], out[1] = q[0], q[1]

    joints = Joints(1, gap, entries, pattern=[[0, 0], [0, 1]])
    system = LinearSystem(sparse.eye_array(2), force=[0.0, -9.81])
    errors = []
    for h in (4e-3, 2e-3):
        run = simulate(Scene(system, [1.0, 0.0], [0.0, 0.0], (0.0, 0.6), joints=joints), Moreau(h))
        errors.append(np.max(np.abs(0.5 * np.sum(run.v**2, axis=1) + 9.81 * run.q[:, 1])))
    assert errors[1] < 1e-4 * 9.81
    assert np.log2(errors[0] / errors[1]) > 1.8


def test_joints_that_contradict_each_other_end_the_run_with_what_was_computed():
    def pulled(t, q, v, p, out):
        out[0, 0], out[0, 1], out[0, 2] = 0.0, 0.0, 0.0
        out[1, 0], out[1, 1], out[1, 2] = t * t, 2.0 * t, 2.0

    J = sparse.csr_array([[1.0, 0.0], [1.0, 0.0]])
    scene = Scene(
        LinearSystem(sparse.eye_array(2)), [0.0, 1.0], [0.0, 0.0], (0.0, 1.0), LinearContacts([[0.0, 1.0]]),
        LinearJoints(J, motion=pulled),
    )  # fmt: skip
    run = simulate(scene, Moreau(1e-2))
    assert run.status == Status.JOINTS_FAILED
    assert "contradict" in run.message
    assert np.isfinite(run.q).all()


@pytest.mark.parametrize("mu", [0.0, 0.3])
def test_walls_that_close_on_a_body_end_the_run(mu):
    def closing(t, q, v, p, out):
        out[0, 0], out[0, 1], out[0, 2] = t - 1.0, 1.0, 0.0
        out[1, 0], out[1, 1], out[1, 2] = t - 1.0, 1.0, 0.0

    walls, along = sparse.csr_array([[1.0, 0.0], [-1.0, 0.0]]), sparse.csr_array([[0.0, 1.0]] * 2)
    contacts = LinearContacts(walls, motion=closing, friction=Coulomb(mu, along))
    system = LinearSystem(sparse.eye_array(2))
    run = simulate(Scene(system, np.zeros(2), np.zeros(2), (0.0, 1.5), contacts), Moreau(1e-2))
    assert run.status == Status.LCP_FAILED
    assert run.t[-1] == pytest.approx(1.0, abs=0.02)


@pytest.mark.slow
def test_what_these_steps_do_not_know_takes_the_dense_ones():
    flat = scenes.hinged_chain(n=3, t_end=0.1)
    c = flat.contacts
    stronge = Coulomb(0.3, c.friction.tangent, law="stronge")
    impulsive = LinearContacts(c.G, friction=stronge)
    scene = Scene(flat.system, flat.q0, flat.v0, flat.t_span, impulsive, flat.joints, p=flat.p)
    assert Moreau(1e-3).by_sparse_steps(scene) is None
    assert Moreau(1e-3).by_sparse_steps(flat) is CoupledRun
    assert simulate(scene, Moreau(1e-3)).status.name == "DONE"


@pytest.mark.parametrize(
    ("pattern", "named"),
    [
        ([[0, 0]], "pattern: expected whole numbers of shape"),
        ([[0.0], [0.5]], "pattern: expected whole numbers"),
        ([[1], [0]], r"pattern: expected rows in \[0, 1\)"),
        ([[0, 0], [1, 1]], "pattern: expected each entry once"),
    ],
)
def test_a_wrong_pattern_is_named(pattern, named):
    with pytest.raises(ValueError, match=named):
        Joints(1, None, None, pattern=pattern)


def test_a_pattern_with_a_column_too_many_is_named():
    def nothing(t, q, v, p, out):
        out[:] = 0.0

    joints = Joints(1, nothing, nothing, pattern=[[0], [2]])
    with pytest.raises(ValueError, match=r"joints.pattern: expected columns below 2, got 2"):
        Scene(LinearSystem(sparse.eye_array(2)), [0.0, 0.0], [0.0, 0.0], (0.0, 1.0), joints=joints)


@pytest.mark.parametrize(("n", "decades"), [(110, 0.0), (110, 4.0), (110, 5.0), (1000, 3.0)])
@pytest.mark.parametrize("pull", [2.0, 6.0])
def test_columns_of_ever_heavier_bodies_stick_and_slide_on_the_lightest(n, decades, pull):
    """Pulled aside by 2 m/s^2 they stick; by 6 m/s^2, beyond mu g, the lowest slides with all above."""
    m, mu, h = np.logspace(-decades, decades, n), 0.5, 1e-3
    rows, none = sparse.diags_array([np.ones(n), -np.ones(n - 1)], offsets=[0, -1]), sparse.csr_array((n, n))
    G, T = sparse.hstack([rows, none]).tocsr(), sparse.hstack([none, rows]).tocsr()
    system = LinearSystem(sparse.diags_array(np.tile(m, 2)), force=np.append(-9.81 * m, pull * m))
    contacts = LinearContacts(G, friction=Coulomb(mu, T))
    run = simulate(Scene(system, np.zeros(2 * n), np.zeros(2 * n), (0.0, 0.02), contacts), Moreau(h=h))
    borne, forward = h * np.cumsum(m[::-1])[::-1], max(pull - mu * 9.81, 0.0)
    assert run.status == Status.DONE
    assert np.max(np.abs(run.impulse[1:] / (9.81 * borne) - 1.0)) < 3e-13
    assert np.max(np.abs(run.friction_impulse[1:] / ((forward - pull) * borne) - 1.0)) < 3e-13
    assert np.max(np.abs(run.v[:, :n])) == 0.0
    assert np.max(np.abs(run.v[:, n:] - forward * run.t[:, None])) < 1e-7


def test_beads_held_between_linked_ones_move_with_them():
    """The joints had been taken to hold their contacts: velocities drawn to tell were means of their neighbours'."""
    n, rng = 36, np.random.default_rng(0)
    first = np.arange(0, n - 2, 4)
    links = np.zeros((len(first), n))
    links[np.arange(len(first)), first], links[np.arange(len(first)), first + 2] = 1.0, -1.0
    column = np.eye(n) - np.eye(n, k=-1)
    scene = Scene(
        LinearSystem(sparse.eye_array(n), force=rng.normal(size=n)), np.zeros(n), np.zeros(n), (0.0, 0.2),
        LinearContacts(sparse.csr_array(column), restitution=0.3), LinearJoints(sparse.csr_array(links)),
    )  # fmt: skip
    run = simulate(scene, Moreau(1e-2))
    assert run.status is Status.DONE, run.message
    for between in (1, 2):
        np.testing.assert_allclose(run.q[:, first + between], run.q[:, first], atol=1e-12)
    assert np.max(run.penetration) < 1e-12
    assert np.ptp(run.q[-1]) > 1e-3
