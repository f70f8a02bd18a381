"""Where branches of periodic orbits end: closed ones where they began, others where a contact becomes a graze."""

import math

import numpy as np
import pytest

from lagrangian import Harmonic, LinearContacts, LinearSystem, Scene
from lagrangian.scenes import ball_on_table
from lcpstep import EventDriven
from lcpstep.analysis.continuation import continue_point
from lcpstep.analysis.orbits import continue_orbit, periodic_orbit
from lcpstep.maps import StroboscopicMap, iterate


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


@pytest.mark.slow
def test_a_second_contact_that_is_about_to_be_touched_ends_a_branch():
    # A mass strikes the wall before it and has another behind it. As long as that is not touched the orbit does not
    # know of it, and it is grazed where it stands at the orbit's lowest point.
    def make(behind):
        block = LinearSystem(M=1.0, C=0.1, K=1.0, force=Harmonic(cosine=1.0, omega=2.0))
        walls = LinearContacts(G=[[-1.0], [1.0]], offset=[0.0, behind], restitution=0.8)
        return Scene(block, 0.0, 0.0, (0.0, math.pi), contacts=walls, period=math.pi)

    orbit = periodic_orbit(make(9.0), [-2.6596965, 2.58919638])
    lowest = float(np.min(orbit.run().at(np.linspace(0.0, math.pi, 100001))[0]))
    assert orbit.name == "O(1, 1)"
    assert orbit.clearance() == pytest.approx(9.0 + lowest, abs=1e-8)
    branch = continue_orbit(make, orbit, 9.0, (1.0, 9.5), forward=False)
    assert [s.kind for s in branch.special] == ["grazing"]
    assert branch.special[0].p == pytest.approx(-lowest, abs=1e-8)


@pytest.mark.slow
def test_an_impact_that_reaches_the_section_is_no_graze():
    # Two masses, the second between two walls: the motion mirrored is another orbit, so both ways from here lead to
    # grazes at one frequency. On one of them an impact reaches the section before.
    def make(w):
        masses = LinearSystem(
            M=np.eye(2), C=[[0.4, -0.2], [-0.2, 0.2]], K=[[2.0, -1.0], [-1.0, 1.0]],
            force=Harmonic(cosine=[1.0, 0.0], omega=w),
        )  # fmt: skip
        walls = LinearContacts(G=[[0.0, -1.0], [0.0, 1.0]], offset=[0.2, 0.2], restitution=0.8)
        return Scene(
            masses, [0, 0], [0, 0], (0.0, 10.0), contacts=walls, period=2 * math.pi / w, parameters={"w": w}
        )

    orbit = periodic_orbit(make(1.5), [-0.754041863, -0.108500295, 1.846346077, 0.140288167])
    up, down = (continue_orbit(make, orbit, 1.5, (1.2, 1.6), forward=forward) for forward in (True, False))
    assert "an impact reaches the section" in up.points.ended
    assert [s.kind for s in up.special] == ["flip"]
    last = up.orbits[-1]
    on = continue_orbit(make, last, last.scene.parameters["w"], (1.2, 1.6), forward=False)
    assert [s.kind for s in on.special] == ["grazing"]
    assert [s.kind for s in down.special] == ["flip", "grazing"]
    assert on.special[0].p == pytest.approx(down.special[1].p, abs=1e-7)
    assert up.special[0].p == pytest.approx(down.special[0].p, abs=1e-9)


def test_a_ball_that_chatters_and_rests_is_followed_until_its_chattering_is_cut_off():
    def P(amplitude, phase=0.0):
        return StroboscopicMap(ball_on_table(amplitude=amplitude), EventDriven(), phase=phase)

    x = iterate(P(0.009), [0.05, 0.0], 60)[-1]
    orbit = periodic_orbit(ball_on_table(amplitude=0.009), x)
    assert orbit.name == "O(1, chattering)"
    branch = continue_orbit(
        lambda amplitude: ball_on_table(amplitude=amplitude), orbit, 0.009, (0.0088, 0.02)
    )
    # There the ball is thrown off before it has come to rest: that is no graze, soft as the last impacts are
    assert branch.special == ()
    assert branch.points.ended.startswith("no point")
    end = branch.points.p[-1]
    assert 0.012 < end < 0.014
    before, after = (
        P(end + step, branch.phase).follow(branch.points.x[-1], 9).ends for step in (-1e-6, 1e-6)
    )
    assert np.all(before == 1)
    assert np.all(after == 0)


@pytest.mark.filterwarnings("error")
def test_a_branch_ends_before_points_that_have_no_derivative():
    class Bent:
        def __init__(self, p):
            self.p = p

        def __call__(self, x):
            return 0.5 * x + self.p

        def jacobian(self, x):
            return np.array([[0.5 if self.p < 0.7 else math.nan]])

    branch = continue_point(Bent, [0.2], 0.1, (0.0, 1.0))
    assert branch.ended.startswith("no point of the branch beyond")
    assert branch.p[-1] == pytest.approx(0.7, abs=1e-4)
    assert np.all(np.isfinite(branch.multipliers))
