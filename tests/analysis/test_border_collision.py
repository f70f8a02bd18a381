"""Border collisions of piecewise-linear maps: known scenarios, and what Feigin's counts must agree with."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from lcpstep.analysis.border_collision import (
    NotContinuous,
    PiecewiseLinearMap,
    classify,
    diagram,
)
from lcpstep.analysis.normal_form import canonical_form
from lcpstep.analysis.normal_form import normal_form as with_the_border_at_zero


def one_dimensional(a, b):
    """x -> a x + m for x < 0, b x + m for x > 0."""
    return PiecewiseLinearMap(a, b, 1.0, 1.0, 1.0, 0.0)


def normal_form(tau_minus, delta_minus, tau_plus, delta_plus):
    """Two-dimensional normal form, S. Banerjee, C. Grebogi, Phys. Rev. E 59 (1999)."""
    left, right = ([[t, 1.0], [-d, 0.0]] for t, d in ((tau_minus, delta_minus), (tau_plus, delta_plus)))
    return PiecewiseLinearMap(left, right, [1.0, 0.0], [1.0, 0.0], [1.0, 0.0], 0.0)


@pytest.mark.parametrize(
    ("f", "verdict", "doubling"),
    [
        (one_dimensional(0.5, 0.8), "persistence", False),
        (one_dimensional(0.5, 1.5), "nonsmooth fold", False),
        (one_dimensional(0.5, -0.5), "persistence", False),
        (one_dimensional(0.5, -1.5), "persistence", True),  # period one to period two
        (one_dimensional(1.5, -1.5), "nonsmooth fold", True),  # a tent map: chaos out of nothing
        (one_dimensional(-1.5, -1.2), "persistence", False),
        (normal_form(0.5, 0.2, -0.4, 0.3), "persistence", False),
        (normal_form(0.5, 0.2, 1.8, 0.3), "nonsmooth fold", False),
        (normal_form(0.5, 0.2, -1.8, 0.3), "persistence", True),
        (normal_form(1.7, 0.5, -1.7, 0.5), "nonsmooth fold", True),  # the Lozi map's robust chaos
    ],
)
def test_known_scenarios_are_told_apart(f, verdict, doubling):
    found = classify(f)
    assert (found.verdict, found.period_doubling) == (verdict, doubling)


number = st.floats(-2.0, 2.0)


@st.composite
def continuous_maps(draw, d=3):
    rng = np.random.default_rng(draw(st.integers(0, 2**32 - 1)))
    A, B, C, E = rng.normal(size=(d, d)), rng.normal(size=d), rng.normal(size=d), rng.normal(size=d)
    D = float(rng.normal())
    return PiecewiseLinearMap(A, A + np.outer(E, C), B, B + E * D, C, D)


@settings(max_examples=200, deadline=None)
@given(continuous_maps())
def test_the_counts_agree_with_where_fixed_points_and_two_cycles_are(f):
    found = classify(f)
    below = found.fixed.minus_exists[0] + found.fixed.plus_exists[0]
    above = found.fixed.minus_exists[1] + found.fixed.plus_exists[1]
    one = np.eye(3)
    if found.verdict == "persistence":
        assert below == above == 1
    else:
        assert sorted([below, above]) == [0, 2]
    if found.period_doubling:
        assert sum(found.two_cycle) == 1
    assert (found.verdict == "nonsmooth fold") == (
        np.linalg.det(one - f.A_minus) * np.linalg.det(one - f.A_plus) < 0.0
    )


@settings(max_examples=50, deadline=None)
@given(continuous_maps())
def test_the_canonical_form_is_the_same_map_in_companion_matrices(f):
    g = canonical_form(f)
    for A, B in ((g.A_minus, f.A_minus), (g.A_plus, f.A_plus)):
        scale = max(1.0, np.max(np.abs(np.poly(B))))
        np.testing.assert_allclose(A[:, 0], -np.poly(B)[1:], atol=1e-6 * scale)
        np.testing.assert_allclose(A[:, 1:], np.eye(3)[:, :2], atol=1e-6 * scale)
    np.testing.assert_allclose(g.C, [1.0, 0.0, 0.0], atol=1e-9)
    assert g.gap()[0] < 1e-6


@settings(max_examples=50, deadline=None)
@given(continuous_maps())
def test_the_normal_form_is_the_same_map_with_its_border_at_zero(f):
    form = with_the_border_at_zero(f)
    random = np.random.default_rng(0)
    for _ in range(6):
        x, m = random.normal(size=3), random.normal()
        y = form.W @ x + form.shift * m
        assert y[0] == pytest.approx(f.C @ x + f.D * m, abs=1e-9)
        A = form.A_minus if y[0] < 0.0 else form.A_plus
        scale = max(1.0, np.max(np.abs(form.W)), np.max(np.abs(form.A_plus)), np.max(np.abs(form.A_minus)))
        np.testing.assert_allclose(
            form.W @ f(x, m) + form.shift * m, A @ y + form.B * m, atol=1e-7 * scale**2
        )


def test_a_map_that_tears_at_its_border_is_refused_with_the_size_of_the_tear():
    f = PiecewiseLinearMap(np.eye(2), [[1.0, 0.0], [0.0, 2.0]], [0.0, 0.0], [0.0, 0.0], [1.0, 0.0], 0.0)
    with pytest.raises(NotContinuous, match=r"not continuous") as caught:
        classify(f)
    assert caught.value.gap == pytest.approx(0.5)


def test_the_diagram_of_a_map_in_one_dimension_is_its_fixed_point_and_its_two_cycle():
    f = one_dimensional(0.5, -1.5)
    points = diagram(f, [-1.0, 1.0], drop=2000, keep=6)
    np.testing.assert_allclose(points[0][:, 0], -2.0)  # -1 / (1 - 0.5)
    low, high = sorted(set(np.round(points[1][:, 0], 9)))
    # x = -1.5 y + 1, y = 0.5 x + 1
    assert low == pytest.approx((1.0 - 1.5) / 1.75)
    assert high == pytest.approx(0.5 * low + 1.0)


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        (([[1.0]], [[1.0]], [1.0], [1.0], [0.0], 0.0), "C: expected a border"),
        (([[1.0]], [[1.0, 2.0]], [1.0], [1.0], [1.0], 0.0), "A_plus: expected shape"),
        (([[1.0]], [[np.nan]], [1.0], [1.0], [1.0], 0.0), "A_plus: expected finite"),
    ],
)
def test_what_is_no_map_is_named(arguments, said):
    with pytest.raises(ValueError, match=said):
        PiecewiseLinearMap(*arguments)
