"""Derivatives of periods in closed form, the exponents that they add up to, and branches followed with them."""

import math

import numpy as np
import pytest

from lagrangian import Harmonic, LinearContacts, LinearSystem, Scene, System
from lagrangian.scenes import cam_follower, impact_oscillator
from lcpstep import EventDriven, Located, Moreau
from lcpstep.analysis.attractors import attractors
from lcpstep.analysis.branch_data import branch_dataset
from lcpstep.analysis.continuation import Steps, continue_point
from lcpstep.analysis.derivative import differences
from lcpstep.analysis.lyapunov import lyapunov
from lcpstep.analysis.orbits import continue_orbit, periodic_orbit
from lcpstep.analysis.variation import PeriodMap
from lcpstep.cli import main
from lcpstep.plot.orbits import stretches
from tests.marks import slow

CASES = [
    {},
    {"coordinates": "absolute"},
    {"b": 3.0, "g0": 9.81, "restitution": 0.6},
    {"b": 200.0, "coordinates": "absolute"},  # overdamped
]


@pytest.mark.parametrize("values", CASES)
@pytest.mark.parametrize("phase", slow([0.0, 0.37], longest=[0.0]))
def test_derivatives_of_periods_are_those_of_the_map(values, phase):
    P = PeriodMap(cam_follower(rpm=660.0, **values), EventDriven(), phase)
    # At a phase of its own the obstacle may lie above the start of the scene
    x = P.follow([0.9, 3.0], 40, 39).final[0]
    images, derivatives = P.along(x, 12)
    for y, image, J in zip([x, *images[:-1]], images, derivatives, strict=True):
        assert np.array_equal(P(y), image)
        size = np.max(np.abs(J))
        assert pytest.approx(P.differentiated(y), abs=1e-11 * size) == J  # walking along the events
        if size > 0.0:
            assert pytest.approx(differences(P, y, 1e-6), abs=1e-5 * size) == J


def test_a_forced_oscillator_above_its_stop_has_its_area_law():
    # det DP = r^2m exp(-2 delta T), whatever the impacts are
    scene = impact_oscillator(omega=1.3, amplitude=0.9, stop=0.2)
    P = PeriodMap(scene, EventDriven())
    run = P.follow(np.concatenate([scene.q0, scene.v0]), 60, tangents=True)
    p = scene.parameters
    damping = math.exp(-float(scene.system.C[0, 0] / scene.system.M[0, 0]) * scene.period)
    r = float(p.get("restitution", p.get("r", math.nan)))
    held = run.ends[0] == 0
    assert np.sum(run.impacts[0][held]) > 10
    expected = r ** (2.0 * run.impacts[0][held]) * damping
    assert np.linalg.det(run.tangents[0][held]) == pytest.approx(expected, rel=1e-9)


def test_a_motion_that_lands_forgets_everything():
    P = PeriodMap(cam_follower(rpm=125.0), EventDriven())
    assert np.all(P.along([0.0, 0.0], 3, 3)[1] == 0.0)
    assert lyapunov(P, [0.0, 0.0], 50).largest == -math.inf


def ramp(t, q, v, p, out):
    """s = t (1 - t) / 2, again and again: its velocity jumps from -1/2 to 1/2."""
    y = t - math.floor(t)
    out[0, 0], out[0, 1], out[0, 2] = 0.5 * y * (1.0 - y), 0.5 - y, -1.0


def test_a_body_at_rest_that_is_kicked_has_forgotten_everything():
    # It rests on the ramp whose velocity jumps under it, and goes on at rest as the ramp falls slower than it would
    body = LinearSystem(M=1.0, force=Harmonic(constant=-9.81))
    table = LinearContacts(G=1.0, restitution=0.3, motion=ramp)
    scene = Scene(body, 0.2, 0.0, (0.0, 1.0), contacts=table, period=1.0, corners=[0.0])
    P = PeriodMap(scene, EventDriven(), 0.6)
    x = P.follow([0.3, 0.0], 5).final[0]
    assert x == pytest.approx([0.12, -0.1], abs=1e-12)
    assert P.follow(x, 1).impacts[0, 0] == 1  # the kick
    assert np.array_equal(P.jacobian(x), np.zeros((2, 2)))
    assert np.array_equal(P.differentiated(x), np.zeros((2, 2)))
    found = attractors(scene, EventDriven(), [[0.3, 0.0]], phase=0.6).found
    assert [a.lyapunov.largest for a in found] == [-math.inf]


def test_the_exponent_of_a_periodic_orbit_is_that_of_its_multipliers():
    scene = cam_follower(rpm=700.0)
    orbit = periodic_orbit(scene, [1.33, -66.2])
    P = PeriodMap(scene, EventDriven())
    # Both multipliers have the modulus 0.8: the determinant is 0.8^2
    # up to what the direction turns on the way: the spiral is an ellipse of some log 100
    assert lyapunov(P, orbit.x[0], 20_000).largest == pytest.approx(math.log(0.8), abs=math.log(100) / 20_000)


def test_a_branch_ends_at_the_range_both_ways_and_changes_where_its_special_points_are():
    def family(a):
        return lambda x: a - x * x

    ways = [continue_point(family, [0.5], 0.75, (0.1, 0.9), forward=forward) for forward in (False, True)]
    assert [way.p[-1] for way in ways] == [0.1, 0.9]
    for way in ways:
        assert way.x[-1, 0] == pytest.approx(-0.5 + math.sqrt(0.25 + way.p[-1]), abs=1e-12)
    (flip,) = ways[1].of_kind("flip")  # the multiplier -2 x is -1 at a = 3/4 exactly: at the start itself
    assert flip.p == pytest.approx(0.75, abs=1e-9)


@pytest.mark.slow
def test_parts_of_a_branch_are_cut_at_the_flip():
    pytest.importorskip("xarray")
    scene = cam_follower(rpm=735.0)
    settled = PeriodMap(scene, EventDriven()).follow([1.0, -70.0], 300, 299).final[0]
    orbit = periodic_orbit(scene, settled)
    p_range = (730.0, 745.0)
    ways = [
        continue_orbit(lambda p: cam_follower(rpm=p), orbit, 735.0, p_range, forward=forward, steps=Steps())
        for forward in (False, True)
    ]
    data = branch_dataset(ways, "rpm", p_range, scene, EventDriven())
    (p, _, stable), (rest, _, other) = stretches(data)
    assert (stable, other) == (True, False)
    assert p[0] == 730.0
    assert rest[-1] == 745.0
    assert p[-1] == rest[0] == pytest.approx(739.3197802, abs=1e-7)


def test_a_branch_that_is_interrupted_is_saved_as_far_as_it_came(capsys, tmp_path, monkeypatch):
    xarray = pytest.importorskip("xarray")
    calls = []

    def stop(self, state):
        calls.append(float(state.z[-1]))
        if len(calls) == 6:
            raise KeyboardInterrupt

    monkeypatch.setattr("lcpstep.analysis.predictor.Follower.tell", stop)
    arguments = "orbit cam-follower --rpm 700 --range 690 710"
    assert main([*arguments.split(), "--out", str(tmp_path)]) == 130
    assert "ended: interrupted" in capsys.readouterr().out
    with xarray.open_dataset(tmp_path / "branch.nc") as data:
        assert data["rpm"].values[::-1].tolist() == calls


def test_orbit_draws_itself(tmp_path):
    assert main(["orbit", "cam-follower", "--rpm", "700", "--draw", "--out", str(tmp_path)]) == 0
    assert (tmp_path / "orbit.png").stat().st_size > 1000


@pytest.mark.parametrize("method", [EventDriven(), Located(h=5e-3), Moreau(h=5e-4)])
def test_a_body_that_rests_all_the_time_forgets_everything_by_any_method(method):
    # The table's acceleration never exceeds gravity; by free flight the exponent would be zero
    body, table = LinearSystem(M=1.0, force=-9.81), LinearContacts(G=1.0, restitution=0.3, motion=swaying)
    scene = Scene(body, 0.1, 0.0, (0.0, 1.0), contacts=table, period=1.0)
    (found,) = attractors(scene, method, [[0.1, 0.0]], transient=40, window=20, longest=4, phase=0.2).found
    assert found.name == "O(1, 0)"
    assert found.lyapunov.largest == -math.inf
    x = found.points[0]
    assert np.array_equal(PeriodMap(scene, method, 0.2).along(x, 3)[1], np.zeros((3, 2, 2)))


def swaying(t, q, v, p, out):
    w = 2.0 * math.pi
    s, c = 0.05 * math.sin(w * t), 0.05 * w * math.cos(w * t)
    out[0, 0], out[0, 1], out[0, 2] = s, c, -(w**2) * s


def softened(t, q, v, p, out):
    out[0] = -0.2 * v[0] - q[0] - 0.5 * q[0] ** 3 + 0.4 * math.cos(1.3 * t)


@pytest.mark.parametrize("method", [Located(h=0.02, order=4), Moreau(h=2e-3)])
def test_a_smooth_motion_by_time_stepping_has_the_exponent_of_its_damping(method):
    # The multipliers of the resonant motion are a conjugate pair: their product is exp(-c T)
    scene = Scene(System(1, [[1.0]], softened), 0.0, 0.0, (0.0, 1.0), period=2.0 * math.pi / 1.3)
    (found,) = attractors(scene, method, [[0.1, 0.0]], transient=60, window=20, longest=4).found
    assert found.name == "O(1, 0)"
    assert found.lyapunov.largest == pytest.approx(-0.1 * scene.period, rel=1e-4)
