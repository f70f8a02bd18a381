"""Roots sought between two places, against numbers known in closed form, and against SciPy's method of Brent."""

import math

import numpy as np
import pytest
from scipy.optimize import brentq

from tests import uncompiled

KERNELS = uncompiled.kernels("lcpstep.kernels")
EPS = 2.0**-52
A, B = 0.0, 4.0
FUNCTIONS = {  # f, f', root in (A, B)
    "cosine": (math.cos, lambda x: -math.sin(x), 0.5 * math.pi),
    "square": (lambda x: x * x - 2.0, lambda x: 2.0 * x, math.sqrt(2.0)),
    "arctangent": (
        lambda x: math.atan(20.0 * (x - 3.0)),
        lambda x: 20.0 / (1.0 + 400.0 * (x - 3.0) ** 2),
        3.0,
    ),
    "exponential": (
        lambda x: math.exp(8.0 * x) - 2.0,
        lambda x: 8.0 * math.exp(8.0 * x),
        math.log(2.0) / 8.0,
    ),
    "small": (lambda x: x - 1e-9, lambda x: 1.0, 1e-9),
}
RULES = ("newton", "chord", "halves")


def sought(f, slope, rule, a=A, b=B, spanned=True, small=4.0 * EPS, guess=math.nan):
    """The bracket in the end, and where it was looked for."""
    r, places = KERNELS.bracket.Bracket(), []
    if spanned:
        r.span(a, f(a), b, f(b))
    else:
        r.begin(a, b, f(a) > 0.0, guess)
    while r.seek(small * abs(r.x)):
        places.append(r.x)
        if rule == "newton":
            r.newton(f(r.x), slope(r.x))
        elif rule == "chord":
            r.chord(f(r.x))
        else:
            r.take(f(r.x), 0.0)
    return r, places


@pytest.mark.parametrize("spanned", [True, False])
@pytest.mark.parametrize("rule", RULES)
@pytest.mark.parametrize("name", FUNCTIONS)
def test_a_root_is_found_to_rounding_by_slopes_chords_and_halves(name, rule, spanned):
    f, slope, root = FUNCTIONS[name]
    r, places = sought(f, slope, rule, spanned=spanned)
    assert r.x == pytest.approx(root, rel=8.0 * EPS)
    assert r.x == pytest.approx(brentq(f, A, B, xtol=1e-300, rtol=4.0 * EPS), rel=12.0 * EPS)
    assert all(A < x < B for x in places)
    assert len(places) <= {"newton": 35, "chord": 45, "halves": 90}[rule]


@pytest.mark.parametrize("rule", RULES[:2])
def test_a_smooth_function_is_looked_at_a_few_times(rule):
    f, slope, _root = FUNCTIONS["square"]
    assert len(sought(f, slope, rule)[1]) <= 9


@pytest.mark.parametrize("rule", RULES)
def test_where_a_function_jumps_through_zero_the_bracket_closes_around_the_jump(rule):
    place = 1.0 + 1e-3

    def f(x):
        return 1.0 if x < place else -1.0

    r, _ = sought(f, lambda x: 1e6, rule, small=0.0)
    assert r.a < place <= r.b
    assert r.b == np.nextafter(r.a, np.inf)


def test_a_slope_of_the_wrong_sign_does_not_lead_out_of_the_bracket():
    f, slope, root = FUNCTIONS["square"]
    r, places = sought(f, lambda x: -slope(x), "newton")
    assert r.x == pytest.approx(root, rel=8.0 * EPS)
    assert all(A < x < B for x in places)


def test_a_small_value_that_grows_before_it_turns_is_no_root():
    """As of a force that begins at zero, to rounding, pulls first and presses later."""

    def f(x):
        return -1e-20 + x * (x - 1.0)

    for spanned in (True, False):
        r, _ = sought(f, lambda x: 2.0 * x - 1.0, "newton", 0.0, 2.0, spanned=spanned, guess=1e-20)
        assert r.x == pytest.approx(1.0, rel=4.0 * EPS)


def test_no_digits_are_sought_in_the_rounding_of_a_function():
    """As of a gap that is the difference of two positions a million times larger."""

    def f(x: float) -> float:
        return (1e6 + (math.exp(x) - 2.0)) - 1e6

    for guess in (math.nan, math.log(2.0) + 1e-12):
        r, places = sought(f, math.exp, "newton", spanned=False, guess=guess)
        assert r.x == pytest.approx(math.log(2.0), abs=1e-9)
        assert len(places) <= 9


def test_a_root_at_an_end_is_that_end_and_nothing_is_looked_at():
    for a, b in ((2.0, 3.0), (1.0, 2.0)):
        r, places = sought(lambda x: x - 2.0, lambda x: 1.0, "newton", a, b)
        assert r.x == 2.0
        assert places == []


def test_a_zero_met_exactly_closes_the_bracket():
    r, places = sought(lambda x: x - 2.0, lambda x: 0.0, "halves", spanned=False)
    assert (r.a, r.b, r.x, places) == (2.0, 2.0, 2.0, [2.0])


def test_the_search_ends_where_the_function_is_not_a_number():
    for rule in RULES:
        r, places = sought(lambda x: math.nan, lambda x: math.nan, rule, spanned=False)
        assert A <= r.x <= B
        assert len(places) <= 200
