"""How a span is divided into steps: whole ones, and a shorter last one where there is time for it."""

import numpy as np
import pytest

from lagrangian import LinearContacts, LinearSystem, Scene
from lcpstep import Located, Moreau, simulate
from lcpstep.stepping.steps import divided


@pytest.mark.parametrize(
    ("start", "h", "n"), [(-549.0, 2.38e-05, 4), (83800.0, 8.2e-05, 240), (0.0, 0.1, 7), (1e6, 0.3, 3)]
)
def test_rounding_of_late_times_is_no_step(start, h, n):
    """The end of the span is a number of few digits, and known no better than that."""
    span = (start, float(f"{start + n * h:.13g}"))
    (size, first_time, first, last), *more = divided(span, h)
    assert not more
    assert (first_time, first, last) == (start, 0, n)
    assert size == pytest.approx(h, rel=1e-5)


@pytest.mark.parametrize("h", [0.3, 0.34, 0.9999])
def test_what_is_left_of_a_span_is_a_shorter_step(h):
    steps = list(divided((2.0, 3.0), h))
    assert len(steps) == 2
    assert sum(size * (last - first) for size, _, first, last in steps) == pytest.approx(1.0, rel=1e-15)
    assert steps[1][0] < h


@pytest.mark.parametrize("method", [Moreau, Located])
def test_no_state_is_kept_twice_at_a_late_end(method):
    scene = Scene(
        system=LinearSystem(M=1.0, force=-9.81), contacts=LinearContacts(G=[[1.0]], restitution=0.5), q0=[1e-9],
        v0=[-1e-4], t_span=(-549.0, -548.9999048),
    )  # fmt: skip
    m = simulate(scene, method(2.38e-05))
    assert np.all(np.diff(m.t) > 0.0)
    assert m.t[-1] == scene.t_span[1]
    np.testing.assert_array_equal(m.at(m.t[-1])[0], m.q[-1])
    assert np.all(m.impacts.time <= scene.t_span[1])
