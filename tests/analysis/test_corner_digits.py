"""The corner impact of the cam-follower and max Psi of the controller, against 40 digits."""

import mpmath as mp
import numpy as np
import pytest

from lagrangian.scenes import cam_follower, hybrid_abs
from lagrangian.scenes.cam_follower import PROFILE
from lcpstep import EventDriven
from lcpstep.analysis.abs_cycle import peak
from lcpstep.analysis.corner_branches import orbit_branches, uncertainty
from lcpstep.analysis.corners import corner_impact, local_map
from lcpstep.analysis.derivative import EIGHTH, differences, one_sided
from lcpstep.maps import StroboscopicMap, iterate

FLANK, NOSE = 1, 2  # arcs of the profile


@pytest.fixture(scope="module", autouse=True)
def digits():
    with mp.workdps(40):
        yield


@pytest.fixture(scope="module")
def orbit():
    x = iterate(StroboscopicMap(cam_follower(rpm=700.0), EventDriven()), [0.4, 0.4], 300)[-1]
    return corner_impact(lambda rpm: cam_follower(rpm=rpm), 674.0, x)


def lift(arc, beta):
    """The arc, continued beyond its ends."""
    a = PROFILE.arcs[arc]
    kappa, psi, rho = mp.mpf(a.kappa), mp.mpf(a.psi), mp.mpf(a.rho)
    return (
        kappa * mp.cos(beta - psi)
        + mp.sqrt(rho**2 - (kappa * mp.sin(beta - psi)) ** 2)
        - mp.mpf(PROFILE.offset)
    )


def free(u, v, t):
    w = mp.sqrt(mp.mpf(1430.8) / mp.mpf(1.221))
    return u * mp.cos(w * t) + v / w * mp.sin(w * t), v * mp.cos(w * t) - u * w * mp.sin(w * t)


def period(arc, q, v, rpm):
    """One period of the follower with one impact on the given arc, and how much later than the corner that is."""
    r, turn, start = mp.mpf(0.8), 2 * mp.pi * rpm / 60, mp.mpf(np.pi / 2)
    rest = lift(0, 0)
    corner = (mp.mpf(PROFILE.arcs[FLANK].end) - start) / turn
    hit = mp.findroot(lambda t: free(q + rest, v, t)[0] - lift(arc, start + turn * t), corner)
    u, w = free(q + rest, v, hit)
    w = (1 + r) * mp.diff(lambda t: lift(arc, start + turn * t), hit) - r * w
    u, w = free(u, w, 60 / rpm - hit)
    return mp.matrix([u - rest, w, hit - corner])


def exact_orbit(orbit):
    def closing(q, v, rpm):
        image = period(FLANK, q, v, rpm)
        return image[0] - q, image[1] - v, image[2]

    return mp.findroot(closing, tuple(mp.mpf(float(z)) for z in (*orbit.x, orbit.p)))


@pytest.mark.slow
def test_the_corner_impact_has_thirteen_digits(orbit):
    z = exact_orbit(orbit)
    assert orbit.p == pytest.approx(float(z[2]), rel=1e-13)
    assert orbit.x == pytest.approx([float(z[0]), float(z[1])], rel=1e-13)


@pytest.mark.slow
def test_both_sides_of_the_local_map_have_thirteen_digits_and_their_error_is_known(orbit):
    z, chain = exact_orbit(orbit), local_map(orbit)
    error = uncertainty(orbit, chain)
    d = mp.mpf(10) ** -13
    for arc, side in ((FLANK, "minus"), (NOSE, "plus")):
        columns = []
        for j in range(3):
            ends = [period(arc, *[z[i] + (s * d if i == j else 0) for i in range(3)]) for s in (1, -1)]
            columns.append([float(mp.re(ends[0][i] - ends[1][i]) / (2 * d)) for i in range(2)])
        A, B = np.array(columns[:2]).T, np.array(columns[2])
        for name, exact in ((f"A_{side}", A), (f"B_{side}", B)):
            off = np.max(np.abs(getattr(chain, name) - exact))
            assert off < 2e-13 * np.max(np.abs(exact))
            assert off < 2.0 * error[name]


@pytest.mark.slow
def test_the_branches_of_the_local_map_touch_those_of_the_full_system(orbit):
    values = orbit.p + np.linspace(-1.0, 1.0, 41) * 2e-3
    branches = orbit_branches(orbit, local_map(orbit), values)
    assert [(b.stable, b.local) for b in branches] == [
        (False, True),
        (False, False),
        (True, True),
        (True, False),
    ]
    for straight, curved in zip(branches[::2], branches[1::2], strict=True):
        assert np.array_equal(straight.p, curved.p)
        assert curved.p[0] == orbit.p
        near = [np.max(np.abs(curved.x[k] - straight.x[k])) for k in (10, 20)]
        assert near[1] / near[0] == pytest.approx(4.0, abs=0.4)  # apart as the square of the distance


@pytest.mark.parametrize("road", ["dry", "wet"])
def test_the_largest_holding_torque_is_the_root_of_its_derivative(road):
    scene = hybrid_abs(road)
    th = [mp.mpf(x) for x in {"dry": (1.11, 23.99, 0.52), "wet": (0.687, 33.822, 0.347)}[road]]
    m, r, inertia, g = (mp.mpf(scene.parameters[k]) for k in ("mass", "radius", "inertia", "g"))

    def psi(s):
        mu = th[0] * (1 - mp.exp(-s * th[1])) - s * th[2]
        return (r + inertia * (1 - s) / (r * m)) * m * g * mu

    slip, top = peak(scene)
    exact = mp.findroot(lambda s: mp.diff(psi, s), (0.11, 0.2), solver="anderson")
    assert slip == pytest.approx(float(exact), rel=1e-14)
    assert top == pytest.approx(float(psi(exact)), rel=1e-14)


def test_limits_from_either_side_are_those_of_the_branches():
    def kinked(t):
        return np.array([np.exp(t) if t < 1.0 else np.exp(2.0 * t)])

    assert one_sided(kinked, 1.0, -1e-4)[0] == pytest.approx(np.e, rel=1e-14)
    assert one_sided(kinked, 1.0, 1e-4)[0] == pytest.approx(np.e**2, rel=1e-13)
    assert differences(np.sin, [0.7], 4e-3, EIGHTH)[0, 0] == pytest.approx(np.cos(0.7), rel=2e-13)
