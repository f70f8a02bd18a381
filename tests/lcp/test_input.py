"""Bad input is named, odd input is converted, input is never modified, and importing is cheap."""

import subprocess
import sys

import numpy as np
import pytest
import scipy.sparse as sp

from lcpstep import EventDriven, Located
from lcpstep.errors import MissingSolver, UnknownName
from lcpstep.lcp import LCP, Solution, residual, solve_lcp, solve_lcp_batch

W = np.array([[2.0, 1.0], [1.0, 3.0]])
b = np.array([-1.0, -1.0])
BAD = [
    ("W", [[1.0, 2.0]], [1.0]),
    ("W", [[1.0, 2.0], [3.0]], [1.0, 2.0]),
    ("W", [1.0, 2.0], [1.0, 2.0]),
    ("W", [[1.0, np.nan], [0.0, 1.0]], [1.0, 2.0]),
    ("W", [[1.0, np.inf], [0.0, 1.0]], [1.0, 2.0]),
    ("W", [[1j, 0.0], [0.0, 1.0]], [1.0, 2.0]),
    ("W", [["a", "b"], ["c", "d"]], [1.0, 2.0]),
    ("W", None, [1.0]),
    ("b", W, [1.0, 2.0, 3.0]),
    ("b", W, [[1.0, 2.0]]),
    ("b", W, [1.0, np.nan]),
    ("b", W, [1.0, -np.inf]),
    ("b", W, [1.0, 1j]),
    ("b", W, 1.0),
]


@pytest.mark.parametrize("method", ["lemke", "auto", "newton", "enumeration", "pgs", "qp"])
@pytest.mark.parametrize(("name", "bad_W", "bad_b"), BAD)
def test_bad_input_is_a_value_error_that_names_the_argument(name, bad_W, bad_b, method):
    with pytest.raises(ValueError, match=rf"^{name} "):
        solve_lcp(bad_W, bad_b, method)


@pytest.mark.parametrize(("name", "bad_W", "bad_b"), BAD)
def test_a_problem_checks_itself(name, bad_W, bad_b):
    with pytest.raises(ValueError, match=rf"^{name} "):
        LCP(bad_W, bad_b)


def test_bad_guess_is_named():
    for guess in ([1.0], [np.nan, 0.0], [[1.0, 2.0]]):
        with pytest.raises(ValueError, match=r"^guess "):
            solve_lcp(W, b, guess=guess)


@pytest.mark.parametrize("method", ["lemke", "auto", "newton", "enumeration", "pgs", "qp"])
def test_empty_problem_has_the_empty_solution(method):
    s = solve_lcp(np.empty((0, 0)), np.empty(0), method)
    assert s.solved
    assert s.z.shape == s.w.shape == (0,)
    assert s.residual == 0.0
    assert solve_lcp([], [], method).solved


@pytest.mark.parametrize("method", ["lemke", "auto", "newton", "enumeration", "pgs", "qp"])
def test_integers_single_precision_lists_and_views_are_taken(method):
    expected = solve_lcp(W, b).z
    wide = np.zeros((4, 4))
    wide[::2, ::2] = W
    for odd_W, odd_b in [
        (W.astype(int), b.astype(int)),
        (W.astype(np.float32), b.astype(np.float32)),
        (W.tolist(), b.tolist()),
        (wide[::2, ::2], np.repeat(b, 2)[::2]),
        (np.asfortranarray(W), b[::-1][::-1]),
        (W.astype(">f8"), b.astype(">f8")),
        (sp.csc_array(W), b),
        (sp.coo_matrix(W), b),
    ]:
        assert solve_lcp(odd_W, odd_b, method).z == pytest.approx(expected, abs=1e-9)


@pytest.mark.parametrize("method", ["lemke", "auto", "newton", "enumeration", "pgs", "qp"])
def test_input_is_not_modified_and_may_be_read_only(method):
    fixed_W, fixed_b, guess = W.copy(), b.copy(), np.ones(2)
    for array in (fixed_W, fixed_b, guess):
        array.flags.writeable = False
    s = solve_lcp(fixed_W, fixed_b, method, guess=guess)
    assert s.solved
    assert np.array_equal(fixed_W, W)
    assert np.array_equal(fixed_b, b)
    unsorted = sp.csr_array((np.array([1.0, 2, 3, 1]), np.array([1, 0, 1, 0]), np.array([0, 2, 4])))
    before = unsorted.indices.copy(), unsorted.data.copy()
    assert solve_lcp(unsorted, b, method).z == pytest.approx(s.z, abs=1e-9)
    assert np.array_equal(unsorted.indices, before[0])
    assert np.array_equal(unsorted.data, before[1])


def test_unknown_methods_are_named_and_the_near_ones_suggested():
    with pytest.raises(UnknownName, match="lemke"):
        solve_lcp(W, b, "lemkee")
    with pytest.raises(UnknownName, match="qp:daqp"):
        solve_lcp(W, b, "qp:dapq")
    with pytest.raises(UnknownName):
        solve_lcp(W, b, 3)


def test_missing_qp_solver_says_how_to_install_it(monkeypatch):
    import qpsolvers

    monkeypatch.setattr(qpsolvers, "available_solvers", [])
    with pytest.raises(MissingSolver, match="pip install"):
        solve_lcp(W, b, "qp:daqp")


def test_batch_names_bad_arguments():
    with pytest.raises(ValueError, match=r"^W "):
        solve_lcp_batch(np.ones((2, 3, 2)), np.ones((2, 2)))
    with pytest.raises(ValueError, match=r"^b "):
        solve_lcp_batch(np.ones((2, 2, 2)), [[1.0, np.nan], [0.0, 0.0]])
    with pytest.raises(ValueError, match=r"^W "):
        solve_lcp_batch(np.full((2, 2, 2), np.nan), np.ones((2, 2)))
    with pytest.raises(ValueError, match=r"^guess "):
        solve_lcp_batch(np.ones((2, 2, 2)), np.ones((2, 2)), guess=np.ones(2))
    with pytest.raises(ValueError, match=r"^guess "):
        solve_lcp_batch(np.ones((2, 2, 2)), np.ones((2, 2)), guess=np.full((2, 2), np.nan))
    assert solve_lcp_batch(np.ones((0, 3, 3)), np.ones((0, 3))).z.shape == (0, 3)


@pytest.mark.parametrize("tol", [-1.0, np.nan, "tight", None])
def test_tolerances_that_nothing_can_meet_are_named(tol):
    with pytest.raises(ValueError, match=r"^tol "):
        solve_lcp(W, b, tol=tol)
    with pytest.raises(ValueError, match=r"^tol "):
        solve_lcp_batch(W, b[None], tol=tol)


@pytest.mark.parametrize("most", [-1, 2.5, True, "many", np.nan])
@pytest.mark.parametrize("method", ["lemke", "auto", "newton", "pgs", "qp", "enumeration"])
def test_numbers_of_iterations_that_are_none_are_named(most, method):
    with pytest.raises(ValueError, match=r"^max_iterations must be an integer >= 0"):
        solve_lcp(W, b, method, max_iterations=most)
    with pytest.raises(ValueError, match=r"^max_iterations must be an integer >= 0"):
        solve_lcp_batch(W, b[None], max_iterations=most)


def test_a_million_may_be_written_as_a_float():
    assert solve_lcp(W, b, "pgs", max_iterations=1e6).solved
    assert EventDriven(max_events=1e6).max_events == Located(1e-3, max_events=1e6).max_events == 10**6


def test_lists_are_judged_beside_a_sparse_matrix():
    assert residual(sp.csr_array(W), list(b), [0.4, 0.2]) == residual(W, b, [0.4, 0.2])


def test_a_quadratic_programme_without_iterations_is_no_error_of_its_solver():
    assert solve_lcp(W, b, "qp", max_iterations=0).method == "qp:osqp"


def test_overflow_is_not_called_solved():
    s = solve_lcp([[5e-324]], [-1e308])
    assert not s.solved
    assert residual(np.array([[1e300]]), np.array([-1.0]), np.array([1e300])) == np.inf


def test_importing_loads_numpy_only():
    code = (
        "import sys, importlib.util, types; root = types.ModuleType('lcpstep');"
        "root.__path__ = list(importlib.util.find_spec('lcpstep').submodule_search_locations);"
        "sys.modules['lcpstep'] = root; import lcpstep.lcp;"
        "assert not {'numba', 'scipy', 'qpsolvers'} & set(sys.modules), sorted(sys.modules)"
    )
    subprocess.run([sys.executable, "-c", code], check=True)


def test_a_solution_is_frozen():
    s = solve_lcp(W, b)
    assert isinstance(s, Solution)
    with pytest.raises(AttributeError):
        s.z = None
