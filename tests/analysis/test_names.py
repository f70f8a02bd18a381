"""Names of attractors: one each, by either method, told apart up to what the grid of time-stepping does."""

import numpy as np
import pytest

from lagrangian import LinearContacts, LinearSystem, Scene
from lagrangian.scenes import cam_follower
from lcpstep import EventDriven, Moreau
from lcpstep.analysis.attractors import attractors
from lcpstep.analysis.exponents import mean_impacts
from lcpstep.analysis.grid_error import spread
from lcpstep.analysis.grouping import Settled, grouped, overlap
from lcpstep.analysis.lyapunov import growth_of_runs
from lcpstep.analysis.starts import outside, random_starts
from lcpstep.analysis.variation import PeriodMap
from lcpstep.maps import periods

BOX = [[0.0, -60.0], [1.5, 60.0]]


def found(rpm, method, n=40, seed=0, **settings):
    scene = cam_follower(rpm=rpm)
    return attractors(scene, method, outside(scene, random_starts(BOX, n, seed), 0.0), **settings)


@pytest.mark.slow
def test_time_stepping_names_the_two_orbits_at_358_5_rpm_as_event_driven_does():
    exact, stepped = found(358.5, EventDriven()), found(358.5, Moreau(h=1e-4))
    assert exact.settings["tolerance"] == 1e-6
    assert {a.name for a in stepped.found} == {a.name for a in exact.found} == {"O(3, 8)", "O(1, 2)"}
    assert len(stepped.found) == 2
    shares = {a.name: a.share for a in exact.found}
    for a in stepped.found:
        deviation = np.sqrt(shares[a.name] * (1.0 - shares[a.name]) / len(stepped.label))
        assert a.share == pytest.approx(shares[a.name], abs=2.0 * deviation)
    # The exponent of O(1, 2) is that of a complex pair, log 0.8^2, wherever its impacts are
    (two,) = [a for a in stepped.found if a.name == "O(1, 2)"]
    assert two.lyapunov.largest == pytest.approx(2.0 * np.log(0.8), abs=1e-6)
    # O(3, 8): log 0.8^16 / 6 on the orbit; the motion with this step lies too far from it to tell
    (three,) = [a for a in stepped.found if a.name == "O(3, 8)"]
    assert np.isnan(three.lyapunov.largest)
    assert "with steps of h/2 to h" in three.lyapunov.reason


@pytest.mark.parametrize(
    ("rpm", "h"),
    [
        (690.0, 1e-4), pytest.param(359.2, 1e-4, marks=pytest.mark.slow),
        pytest.param(358.5, 5e-5, marks=pytest.mark.thorough), pytest.param(358.5, 1e-5, marks=pytest.mark.thorough),
        pytest.param(359.2, 3e-5, marks=pytest.mark.thorough),
    ],
)  # fmt: skip
def test_an_exponent_by_time_stepping_is_right_within_its_error_or_not_told(rpm, h):
    scene = cam_follower(rpm=rpm)
    start = [[0.06, 8.5]] if rpm < 500 else [[1.6, -80.0]]
    (exact,) = attractors(scene, EventDriven(), start).found
    (stepped,) = attractors(scene, Moreau(h=h), start, transient=100).found
    assert stepped.name == exact.name
    if np.isfinite(stepped.lyapunov.largest):
        off = abs(stepped.lyapunov.largest - exact.lyapunov.largest)
        assert off <= stepped.lyapunov.error + 1e-9
    else:
        assert stepped.lyapunov.reason


@pytest.mark.slow
def test_a_cycle_that_only_one_grid_has_is_no_attractor():
    scene = cam_follower(rpm=358.5)
    starts = outside(scene, random_starts(BOX, 100, 0), 0.0)[[0, 1, 2, 40, 76]]
    found = attractors(scene, Moreau(h=1e-4), starts).found  # the last two come to a cycle of 19 periods
    assert {a.name for a in found} <= {"O(3, 8)", "O(1, 2)"}


@pytest.mark.parametrize("seed", [0, 3])
def test_no_attractor_is_listed_twice_at_361_5_rpm(seed):
    exact = found(361.5, EventDriven(), 60, seed)
    assert sorted(a.name for a in exact.found) == ["O(1, 2)", "chaotic"]


@pytest.mark.slow
def test_chattering_and_chaos_have_their_names_by_time_stepping():
    assert [a.name for a in found(125.0, Moreau(h=1e-4), 6, transient=30, window=60, longest=10).found] == [
        "O(1, chattering)"
    ]
    (chaos,) = found(660.0, Moreau(h=1e-4), 12).found
    assert chaos.name == "chaotic"
    assert chaos.lyapunov.largest == pytest.approx(0.385, abs=0.05)


@pytest.mark.slow
def test_an_attractor_can_be_seen():
    (chaos,) = found(660.0, EventDriven(), 5).found
    assert len(np.unique(chaos.cloud, axis=0)) > 7000
    (stepped,) = found(660.0, Moreau(h=1e-4), 5, points=2000).found
    assert len(np.unique(stepped.cloud, axis=0)) > 1900
    for a in (chaos, stepped):
        assert a.impact_number.min() == 1
        assert np.mean(a.impact_number == 1) > 0.5  # 1.27 impacts per period


def test_the_spread_of_time_stepping_shrinks_with_the_step():
    scene = cam_follower(rpm=700.0)
    x = periods(scene, EventDriven(), [1.33, -66.2], 50).final
    radii = [float(spread(scene, Moreau(h=h), x, 0.0).radius[0]) for h in (1e-4, 2e-5)]
    assert 2.0 < radii[0] / radii[1] < 12.0
    chaotic = spread(cam_follower(rpm=660.0), Moreau(h=1e-4), np.array([[0.9, -3.0]]), 0.0)
    assert not chaotic.forgets[0]


def cloud(random, n, centre):
    return random.normal(size=(n, 2)) + np.asarray(centre)


def test_clouds_of_one_distribution_are_one_and_of_two_are_two():
    random = np.random.default_rng(1)
    one, other = cloud(random, 300, [0.0, 0.0]), cloud(random, 4000, [0.0, 0.0])
    assert overlap(one, other)
    assert overlap(other, one)
    assert not overlap(other, cloud(random, 300, [12.0, 0.0]))
    closed = np.tile(one[:81], (3, 1))  # a cycle that rounding has closed
    assert overlap(closed, other)


def test_a_motion_that_slips_belongs_to_the_orbit_it_slips_along():
    random = np.random.default_rng(2)
    orbit = np.array([[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]])
    noisy = orbit[random.integers(3, size=240)] + 0.01 * random.uniform(-1.0, 1.0, (240, 2))
    regular = np.tile(orbit, (80, 1)) + 0.01 * random.uniform(-1.0, 1.0, (240, 2))
    unit = np.ones(2)
    runs = [
        Settled(0, noisy, unit, 0.03, 0),
        Settled(1, regular, unit, 0.03, 3),
        Settled(2, noisy + 5.0, unit, 0.03, 0),
    ]
    assert sorted(map(sorted, grouped(runs))) == [[0, 1], [2]]


def test_exponents_of_many_runs_are_those_of_products():
    A = np.array([[2.0, 1.0], [1.0, 1.0]])
    derivatives = np.tile(A, (5, 60, 1, 1))
    assert growth_of_runs(derivatives).largest == pytest.approx(np.log((3.0 + np.sqrt(5.0)) / 2.0), abs=1e-9)
    rates = np.random.default_rng(0).uniform(0.0, 1.0, 200)
    growing = np.tile(np.eye(2), (4, 200, 1, 1)) * np.exp(rates)[None, :, None, None]
    assert growth_of_runs(growing).error > 1e-3  # runs that have come together are one
    derivatives[:, 30:32] = 0.0
    assert growth_of_runs(derivatives).largest == -np.inf


@pytest.mark.parametrize("shear", [1e-3, 0.01, 0.1, 1.0, 100.0])
@pytest.mark.parametrize("n", [60, 250, 2000])
def test_many_runs_of_a_shear_are_not_chaotic(n, shear):
    """Its k-th power is (1, k shear; 0, 1), so its exponent is zero."""
    turned = np.array([[0.6, -0.8], [0.8, 0.6]])
    sheared = np.tile(turned @ [[1.0, shear], [0.0, 1.0]] @ turned.T, (32, n, 1, 1))
    assert not growth_of_runs(sheared).chaotic


@pytest.mark.parametrize(
    ("P", "slope", "exponent"),
    [
        (lambda x: 4.0 * x * (1.0 - x), lambda x: 4.0 - 8.0 * x, np.log(2.0)),
        (
            lambda x: np.where(x < 0.3, x / 0.3, (1.0 - x) / 0.7),
            lambda x: np.where(x < 0.3, 1.0 / 0.3, -1.0 / 0.7),
            -0.3 * np.log(0.3) - 0.7 * np.log(0.7),
        ),
    ],
    ids=["logistic", "tent"],
)
def test_many_runs_of_chaotic_maps_are(P, slope, exponent):
    x, slopes = np.random.default_rng(1).uniform(size=32), []
    for _ in range(250):
        slopes.append(slope(x))
        x = P(x)
    found = growth_of_runs(np.transpose(slopes)[:, :, None, None])
    assert found.largest == pytest.approx(exponent, abs=4.0 * found.error)
    assert found.chaotic


@pytest.mark.parametrize("period", [1.0, 0.1])
@pytest.mark.parametrize("stiffness", [0.0, 1.0], ids=["ball", "oscillator"])
def test_motions_that_lose_no_energy_to_an_unmoved_floor_are_aperiodic(stiffness, period):
    scene = Scene(
        LinearSystem(M=1.0, K=stiffness, force=-9.81), q0=1.0, v0=0.0, t_span=(0.0, 1.0), period=period,
        contacts=LinearContacts(1.0, restitution=1.0),
    )  # fmt: skip
    motions = attractors(scene, EventDriven(), [[0.5, 0.1], [0.9, 0.0]], transient=50)
    assert {a.name for a in motions.found} == {"aperiodic"}


def test_mean_impacts_come_to_those_of_the_orbit_as_the_step_goes_down():
    scene = cam_follower(rpm=700.0)
    exact = PeriodMap(scene, EventDriven()).many([1.33, -66.2], 200, 199, most=4)
    errors = []
    for h in (1e-4, 1e-5):
        run = PeriodMap(scene, Moreau(h=h)).many(exact.final, 200, 100, most=4)
        log, counts = mean_impacts(run, 0, 1)
        assert counts.tolist() == [[1, 0]]
        errors.append(abs(log[0, 0, 0] - exact.time[0, 0, 0]) / scene.period)
    assert errors[1] < 0.3 * errors[0]
    assert errors[1] < 1e-3
