"""A slender block that rocks on a shaken floor, as modes with a reset: orbits in closed form, and overturning.

    x'' = x - sign(x) - b cos(w t),    v+ = r v- where x = 0

Source: S. J. Hogan, On the dynamics of rigid-block motion under harmonic forcing, Proc. R. Soc. A 425 (1989).
"""

import math

import numpy as np
import pytest

from lagrangian import Guard, HybridScene, HybridSystem, Mode
from lcpstep import EventDriven
from lcpstep.analysis.attractors import attractors
from lcpstep.analysis.basins import basins
from lcpstep.analysis.orbits import continue_orbit, periodic_orbit


def to_the_right(t, x, p, out):
    out[0], out[1] = x[1], x[0] - 1.0 - p[0] * math.cos(p[1] * t)


def to_the_left(t, x, p, out):
    out[0], out[1] = x[1], x[0] + 1.0 - p[0] * math.cos(p[1] * t)


def angle(t, x, p, out):
    out[0] = x[0]


def blow(t, x, p, out):
    out[0], out[1] = x[0], p[2] * x[1]


def side(t, x, p):
    return "right" if x[0] > 0.0 or (x[0] == 0.0 and x[1] > 0.0) else "left"


MODES = {
    "right": Mode(to_the_right, [Guard(angle, "left", direction=-1, reset=blow)]),
    "left": Mode(to_the_left, [Guard(angle, "right", direction=1, reset=blow)]),
}
BLOCK = HybridSystem(2, MODES, mode_of=side)


def block(b, w, r):
    return HybridScene(BLOCK, [0.1, 0.0], "right", (0.0, 100.0), p=[b, w, r], period=2.0 * math.pi / w)


def symmetric(b, w, r):
    """State at t = 0 of the symmetric orbit, found by Newton's method on its closed form."""
    from scipy.optimize import fsolve

    half, forced = math.pi / w, b / (1.0 + w * w)

    def motion(z, t):
        rise, fall, phase = z
        x = 1.0 + rise * math.exp(t) + fall * math.exp(-t) + forced * math.cos(w * t + phase)
        return x, rise * math.exp(t) - fall * math.exp(-t) - forced * w * math.sin(w * t + phase)

    def closes(z):
        (x, v), (x_end, v_end) = motion(z, 0.0), motion(z, half)
        return [x, x_end, v_end + v / r]

    for guess in np.linspace(0.0, 6.0, 13):
        z, _, done, _ = fsolve(closes, [-1.0, 0.1, guess], full_output=True, xtol=1e-13)
        if done == 1 and min(motion(z, t)[0] for t in np.linspace(0.01 * half, 0.99 * half, 99)) > 0.0:
            t = -z[2] / w % (2.0 * half)
            return np.array(motion(z, t)) if t < half else -np.array(motion(z, t - half))
    raise AssertionError("no orbit")


@pytest.mark.parametrize(("b", "w", "r"), [(3.0, 2.0, 0.9), (8.0, 5.0, 0.5), (0.5, 1.3, 0.925)])
def test_the_symmetric_orbit_is_that_in_closed_form(b, w, r):
    x = symmetric(b, w, r)
    orbit = periodic_orbit(block(b, w, r), x)
    assert orbit.name == "O(1, 2)"
    assert orbit.x[0] == pytest.approx(x, abs=1e-10)
    assert np.prod(orbit.multipliers).real == pytest.approx(
        r**4, rel=1e-9
    )  # flows keep areas, a blow leaves r^2


@pytest.mark.parametrize(
    ("b", "w", "r"),
    [
        (8.0, 5.0, 0.5),
        pytest.param(8.0, 3.0, 0.05, marks=pytest.mark.slow),
        pytest.param(5.0, 4.0, 0.3, marks=pytest.mark.slow),
    ],
)
def test_where_the_orbit_loses_its_symmetry_is_a_branch_point(b, w, r):
    orbit = periodic_orbit(block(b, w, r), symmetric(b, w, r))
    branch = continue_orbit(lambda b: block(b, w, r), orbit, b, (0.2 * b, 1.1 * b), forward=False)
    (special,) = branch.special
    assert special.kind == "branch point"
    assert abs(special.multipliers[0]) == pytest.approx(1.0, abs=1e-5)
    on_either_side = [special.p * (1.0 + share) for share in (-1e-5, 1e-5)]
    below, above = (
        periodic_orbit(block(p, w, r), symmetric(p, w, r)).multipliers[0].real for p in on_either_side
    )
    assert below < 1.0 < above


def test_a_block_that_overturns_goes_to_no_attractor():
    # b = 3, w = 2, r = 0.9: the symmetric orbit is unstable, and nothing else keeps the block upright
    found = attractors(
        block(3.0, 2.0, 0.9), EventDriven(), [[0.3, 0.1], [-0.2, 0.3]], transient=60, window=60, longest=20
    )
    assert found.found == ()
    assert found.label.tolist() == [-1, -1]


@pytest.mark.slow
def test_blocks_that_overturn_are_in_no_basin():
    scene = block(8.0, 5.0, 0.5)
    found = basins(scene, [-3.0, -0.1], [3.0, 0.1], (12, 2), longest=40, sample=0)
    leaning = np.abs(found.q.values) > 1.0 + 8.0 / 26.0 + 0.4  # beyond where it could be held up
    assert np.all(found.label.values[:, leaning] == -1)
    assert set(found.name.values.tolist()) == {"O(1, 2)"}
