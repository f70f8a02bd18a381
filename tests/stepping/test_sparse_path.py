"""Contacts and joints of large sparse problems: modes along a path, from guesses however wrong."""

import numpy as np
import pytest
from scipy import sparse

from lagrangian import scenes
from lcpstep import Moreau, energy, simulate, solve_lcp
from lcpstep.stepping.sparse.coulomb import Coupled, Problem
from lcpstep.stepping.sparse.path import OPEN, STICK, Path
from lcpstep.stepping.sparse.updates import Lines


def row_of_points(seed, n, mu=0.3):
    """Points in a plane, each on the floor and coupled to the next, rods between some; rates at random."""
    rng = np.random.default_rng(seed)
    beside = rng.uniform(0.2, 2.0, n - 1)
    stiff = np.append(beside, 0.0) + np.append(0.0, beside)
    row = sparse.diags_array([stiff, -beside, -beside], offsets=[0, 1, -1])
    A = sparse.csr_array(sparse.eye_array(2 * n) + sparse.kron(row, [[1.0, 0.4], [0.4, 0.8]]))
    k, angle = np.arange(0, n - 1, 3), rng.uniform(-0.4, 0.4, len(range(0, n - 1, 3)))
    along = np.column_stack([-np.cos(angle), -np.sin(angle), np.cos(angle), np.sin(angle)])
    columns = 2 * k[:, None] + np.arange(4)
    J = sparse.csr_array((along.ravel(), (np.repeat(np.arange(len(k)), 4), columns.ravel())), (len(k), 2 * n))
    T, G = (
        sparse.csr_array((np.ones(n), (np.arange(n), 2 * np.arange(n) + i)), shape=(n, 2 * n)) for i in (0, 1)
    )
    b = rng.normal(size=len(k) + 2 * n)
    b[len(k) : len(k) + n] -= 0.5
    everywhere = np.ones(n, dtype=bool)
    problem = Problem(b, np.abs(b), everywhere, everywhere & (mu > 0.0), np.full(n, mu), 1.0)
    return Coupled(A, G, T, J), problem, rng


def violation(coupled, problem, x, p):
    """The worst that x and p do to the law of contacts, friction and joints."""
    n_j, n_c = coupled.n_j, coupled.n_c
    rates, forces = coupled.R @ x + problem.b, coupled.R.T @ p
    (_, u_N, u_T), (_, p_N, p_T) = (np.split(a, (n_j, n_j + n_c)) for a in (rates, p))
    return max(
        np.max(np.abs(coupled.A @ x - forces)), np.max(np.abs(rates[:n_j])), np.max(np.abs(np.minimum(u_N, p_N))),
        np.max(np.abs(p_T) - problem.mu * p_N), np.max(np.abs(u_T * p_T + problem.mu * p_N * np.abs(u_T))),
    )  # fmt: skip


@pytest.mark.parametrize("mu", [0.0, 0.3, 0.8])
def test_any_guess_leads_to_the_answer(mu):
    coupled, problem, rng = row_of_points(1, 150, mu)
    found = []
    for _ in range(3):
        modes = rng.integers(0, 4, 150)
        point = coupled.solve(problem, modes, np.zeros(coupled.n_r))
        assert point.solved
        assert violation(coupled, problem, point.x, point.p) < 1e-11
        found.append(point.x)
    np.testing.assert_allclose(found[1:], [found[0]] * 2, rtol=0, atol=1e-11)


@pytest.mark.parametrize("seed", range(4))
def test_a_path_alone_ends_at_modes_that_fit(seed):
    coupled, problem, rng = row_of_points(seed, 30)
    guesses = np.full(30, OPEN), np.full(30, STICK), rng.integers(0, 2, 30)
    for modes in guesses:
        found = Path(coupled, problem, modes).follow()
        point = coupled.settle(problem, found, np.zeros(coupled.n_r))
        assert point.solved
        np.testing.assert_array_equal(point.fitting, found)
        assert violation(coupled, problem, point.x, point.p) < 1e-11


def test_the_lines_of_every_pivot_are_those_of_a_new_factorisation(monkeypatch):
    coupled, problem, rng = row_of_points(2, 150)
    plain, pivots = Lines.at, []

    def compared(self, tau, changed):
        now = plain(self, tau, changed)
        for line, anew in zip(now, self.path.lines(), strict=True):
            largest = np.max(np.abs(anew))
            # some modes on the way are nearly singular: factors of any kind leave 1e-6 then
            np.testing.assert_allclose(line, anew[:, coupled.n_j :], rtol=0, atol=1e-5 * largest)
        pivots.append(changed)
        return now

    monkeypatch.setattr(Lines, "at", compared)
    assert Path(coupled, problem, rng.integers(0, 4, 150)).follow() is not None
    assert len(pivots) > 100
    assert len(set(pivots)) < len(pivots)  # some change more than once


def test_many_pivots_take_few_factorisations(monkeypatch):
    coupled, problem, rng = row_of_points(2, 150)
    factor, pivot, done = coupled.patterned.factor, Path.change, {"factor": 0, "pivot": 0}

    def counted(name, f):
        def call(*given):
            done[name] += 1
            return f(*given)

        return call

    monkeypatch.setattr(coupled.patterned, "factor", counted("factor", factor))
    monkeypatch.setattr(Path, "change", counted("pivot", pivot))
    assert Path(coupled, problem, rng.integers(0, 4, 150)).follow() is not None
    assert done["pivot"] > 100
    assert done["factor"] < 0.1 * done["pivot"]


def test_without_friction_a_path_ends_at_the_answer_of_a_dense_solver():
    coupled, problem, rng = row_of_points(5, 40, mu=0.0)
    n_j, A = coupled.n_j, coupled.A.toarray()
    J, G = coupled.R[:n_j].toarray(), coupled.G.toarray()
    K = np.block([[A, -J.T], [J, np.zeros((n_j, n_j))]])
    moved = np.linalg.solve(K, np.column_stack([np.vstack([G.T, np.zeros((n_j, 40))]),
                                                np.append(np.zeros(80), -problem.b[:n_j])]))[:80]  # fmt: skip
    answer = solve_lcp(G @ moved[:, :-1], problem.b[n_j : n_j + 40] + G @ moved[:, -1])
    modes = Path(coupled, problem, rng.integers(0, 2, 40)).follow()
    np.testing.assert_array_equal(modes != OPEN, answer.z > 1e-12)


def test_contacts_that_cannot_all_be_met_end_no_path():
    coupled, _, _ = row_of_points(0, 6, mu=0.0)
    squeezed = sparse.vstack([coupled.G[:1], -coupled.G[:1]], format="csr")  # from both sides
    empty = sparse.csr_array((2, 12))
    jaws = Coupled(coupled.A, squeezed, empty, sparse.csr_array((0, 12)))
    both, none = np.ones(2, dtype=bool), np.zeros(2)
    closing = Problem(np.append([-1.0, -1.0], none), np.ones(4), both, ~both, none, 1.0)
    assert not jaws.solve(closing, np.zeros(2, dtype=int), np.zeros(4)).solved


@pytest.mark.usefixtures("sparse_steps")
@pytest.mark.slow
def test_paths_begin_from_the_step_before_rather_than_from_nothing(monkeypatch):
    follow, begun = Path.follow, []

    def seen(self):
        begun.append(np.count_nonzero(self.modes != OPEN))
        return follow(self)

    monkeypatch.setattr(Path, "follow", seen)
    run = simulate(scenes.hinged_chain(n=20, restitution=0.5, t_end=0.4), Moreau(1e-3))
    assert len(begun) > 20
    assert min(begun) > 0
    goes_on(run)


def goes_on(run):
    """Without gaining energy."""
    assert run.status.name == "DONE"
    total = energy(run).total
    assert np.diff(total).max() < 1e-6 * total[0]  # what the joints' rows at the end of a step give
    assert total[-1] < total[0]


@pytest.mark.usefixtures("sparse_steps")
@pytest.mark.thorough
@pytest.mark.parametrize("restitution", [0.3, 0.5])
def test_a_chain_that_bounces_goes_on_while_it_comes_to_lie(restitution):
    run = simulate(scenes.hinged_chain(n=40, restitution=restitution, t_end=0.6), Moreau(1e-3))
    goes_on(run)
