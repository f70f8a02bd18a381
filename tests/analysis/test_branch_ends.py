"""Where branches of periodic orbits end: closed ones where they began, others where a contact becomes a graze."""

import math

import numpy as np
import pytest

from lagrangian import Harmonic, LinearContacts, LinearSystem, Scene
from lcpstep.analysis.continuation import continue_point
from lcpstep.analysis.orbits import continue_orbit, periodic_orbit


@pytest.mark.parametrize("forward", [True, False])
def test_a_closed_branch_is_followed_once_round(forward):
    # Fixed points lie on the circle x^2 + p^2 = 1, which turns back at p = 1 and p = -1
    def family(p):
        return lambda x: x + 0.3 * (1.0 - x * x - p * p)

    branch = continue_point(family, [0.8], 0.6, (-2.0, 2.0), forward=forward)
    assert sorted(s.p for s in branch.special if s.kind == "fold") == pytest.approx([-1.0, 1.0], abs=1e-9)
    assert len(branch.special) == 2
    assert branch.ended.startswith("back where it began")
    assert (branch.p[-1], branch.x[-1]) == (branch.p[0], branch.x[0])
    assert np.all(np.hypot(branch.x[:, 0], branch.p) == pytest.approx(1.0, abs=1e-9))


@pytest.mark.slow
def test_an_impact_that_becomes_a_graze_ends_its_branch_in_few_points():
    # The orbit that strikes once a period is the steady oscillation, of amplitude F / |k - m w^2 + i c w|, as soon as
    # the stop is that far. Its multiplier goes to infinity there, and its speed to zero as the distance.
    m, c, k, F, w = 1.8, 0.4, 4.0, 4.9, 3.3
    T = 2.0 * math.pi / w

    def make(offset):
        block = LinearSystem(M=m, C=c, K=k, force=Harmonic(sine=F, omega=w))
        stop = LinearContacts(G=1.0, offset=offset, restitution=0.4)
        return Scene(block, 1.0, 0.0, (0.0, T), contacts=stop, period=T)

    far = F / abs(complex(k - m * w * w, c * w))
    start = 0.93 * far
    orbit = periodic_orbit(make(start), [0.3, -0.7])
    assert orbit.name == "O(1, 1)"
    branch = continue_orbit(make, orbit, start, (0.5 * far, 1.3 * far))
    grazing = branch.special[-1]
    assert grazing.kind == "grazing"
    assert grazing.p == pytest.approx(far, rel=1e-6)
    assert len(branch.orbits) < 100
