"""Systems: what they are made of, and every input that is refused, by the name of its argument."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from lagrangian import Harmonic, LinearSystem, System

NOT_FINITE = st.sampled_from([math.nan, math.inf, -math.inf])
SIZES = st.integers(1, 4)


def fall(t, q, v, p, out):
    out[0] = -9.81


def symmetric(draw, n):
    A = np.array(draw(st.lists(st.lists(st.floats(-1, 1), min_size=n, max_size=n), min_size=n, max_size=n)))
    return 0.5 * (A + A.T)


@st.composite
def definite(draw):
    n = draw(SIZES)
    A = symmetric(draw, n)
    return A @ A + np.eye(n)


@st.composite
def indefinite(draw):
    """Symmetric with a negative eigenvalue of the size of the others."""
    n = draw(SIZES)
    _, Q = np.linalg.eigh(symmetric(draw, n))
    values = np.ones(n)
    values[draw(st.integers(0, n - 1))] = -draw(st.floats(1e-6, 1.0))
    M = Q @ np.diag(values) @ Q.T
    return 0.5 * (M + M.T)


@given(definite())
def test_positive_definite_masses_are_taken_and_kept_from_later_changes(M):
    given_matrix = M.copy()
    system = LinearSystem(M=given_matrix)
    given_matrix[:] = -1.0
    np.testing.assert_array_equal(system.M, M)
    assert system.n_q == len(M)
    with pytest.raises(ValueError, match="read-only"):
        np.asarray(system.M)[0, 0] = 2.0
    assert not np.any(system.C)
    assert not np.any(system.K)
    System(n_q=len(M), mass=M, force=fall)


@given(indefinite())
def test_indefinite_masses_are_refused(M):
    with pytest.raises(ValueError, match=r"^M: .*positive definite.*eigenvalue"):
        LinearSystem(M=M)
    with pytest.raises(ValueError, match=r"^mass: .*positive definite"):
        System(n_q=len(M), mass=M, force=fall)


@given(definite().filter(lambda M: len(M) > 1), st.floats(1e-9, 1.0))
def test_masses_that_are_not_symmetric_are_refused(M, skew):
    M[0, 1] += skew * np.max(np.abs(M))
    with pytest.raises(ValueError, match=r"^M: .*symmetric"):
        LinearSystem(M=M)


@pytest.mark.parametrize("M", [0.0, -1.0, np.zeros((2, 2)), np.diag([1.0, 0.0])])
def test_massless_coordinates_are_refused(M):
    with pytest.raises(ValueError, match=r"^M: .*positive definite"):
        LinearSystem(M=M)


@given(st.sampled_from(["M", "C", "K"]), NOT_FINITE, st.integers(0, 3))
def test_matrices_must_be_finite(name, bad, place):
    matrices = {"M": np.eye(2), "C": np.eye(2), "K": np.eye(2)}
    matrices[name].flat[place] = bad
    with pytest.raises(ValueError, match=rf"^{name}: .*finite"):
        LinearSystem(**matrices)


@pytest.mark.parametrize("name", ["M", "C", "K"])
@pytest.mark.parametrize("bad", [np.ones((2, 3)), np.ones((3, 3, 1)), "stiff", [[1, 2], [3]], np.eye(2) * 1j])
def test_matrices_must_be_square_and_real(name, bad):
    matrices = {"M": np.eye(3), name: bad}
    with pytest.raises(ValueError, match=rf"^{name}: "):
        LinearSystem(**matrices)


def test_a_system_without_coordinates_is_refused():
    with pytest.raises(ValueError, match=r"^M: "):
        LinearSystem(M=np.zeros((0, 0)))


@pytest.mark.parametrize(
    ("force", "named"),
    [
        ([1.0, 2.0, 3.0], "force.constant"),
        (Harmonic(constant=[1.0]), "force.constant"),
        (Harmonic(cosine=[math.nan, 0.0]), "force.cosine"),
        (Harmonic(sine=math.inf), "force.sine"),
        (Harmonic(cosine=1.0, omega=math.nan), "force.omega"),
        (Harmonic(cosine="wind"), "force.cosine"),
        ("wind", "force"),
    ],
)
def test_forces_are_checked_part_by_part(force, named):
    with pytest.raises(ValueError, match=rf"^{named}"):
        LinearSystem(M=np.eye(2), force=force)


def test_a_number_stands_for_all_coordinates():
    constant, cosine, sine = Harmonic(constant=-9.81, sine=[1.0, 2.0]).terms(2)
    np.testing.assert_array_equal(constant, [-9.81, -9.81])
    np.testing.assert_array_equal(cosine, [0.0, 0.0])
    np.testing.assert_array_equal(sine, [1.0, 2.0])


def test_a_system_keeps_its_force_when_the_arrays_that_it_was_made_from_change():
    push, M = np.array([1.0, 2.0]), np.eye(2)
    system = LinearSystem(M=M, force=Harmonic(constant=push, cosine=push, omega=2.0))
    push[0], M[0, 0] = 5.0, 7.0
    np.testing.assert_array_equal(system.force.constant, [1.0, 2.0])
    np.testing.assert_array_equal(system.force.terms(2)[1], [1.0, 2.0])
    assert system.M[0, 0] == 1.0
    with pytest.raises(ValueError, match="read-only"):
        system.force.constant[0] = 3.0


@pytest.mark.parametrize("n_q", [0, -1, 1.5, "one", None])
def test_the_number_of_coordinates_is_a_positive_integer(n_q):
    with pytest.raises(ValueError, match=r"^n_q: "):
        System(n_q=n_q, mass=1.0, force=fall)


def test_the_number_of_coordinates_may_come_from_numpy():
    assert System(n_q=np.shape(np.eye(2))[0], mass=np.eye(2), force=fall).n_q == 2
    assert System(n_q=np.int64(1), mass=1.0, force=fall).n_q == 1


def test_a_general_system_needs_a_function_for_its_force():
    with pytest.raises(ValueError, match=r"^force: "):
        System(n_q=1, mass=1.0, force=-9.81)
    with pytest.raises(ValueError, match=r"^mass: "):
        System(n_q=2, mass=np.eye(3), force=fall)


@pytest.mark.parametrize("M", [[1.0, 2.0], [[1.0, 2.0, 3.0], [2.0, 1.0, 0.0]]])
def test_a_matrix_that_is_not_square_is_said_to_be_none(M):
    with pytest.raises(ValueError, match=r"^M: expected a square matrix, got shape \(2,"):
        LinearSystem(M=M)
