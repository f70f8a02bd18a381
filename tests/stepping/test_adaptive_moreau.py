"""Moreau with a tolerance: errors follow it through impacts, corners, chattering and contact that lasts."""

import dataclasses

import numpy as np
import pytest
from scipy import sparse

from lagrangian import Coulomb, LinearContacts, LinearSystem, Scene, System, scenes
from lcpstep import EventDriven, LcpStepError, Moreau, SimulationInterrupted, Status, simulate
from lcpstep.trajectory import Kind
from tests.known import ball_height

TOLERANCES = (1e-2, 1e-3, 1e-4, 1e-5)


def oscillator():
    return dataclasses.replace(scenes.impact_oscillator(), t_span=(0.0, 10.0))


def errors(scene, h, theta=0.5, tolerances=TOLERANCES, until=None):
    """Largest errors of the position at even times, against the event-driven motion; penetrations at all steps."""
    at = np.linspace(scene.t_span[0], until or scene.t_span[1], 201)
    true = simulate(scene, EventDriven(), keep=at).q
    apart, deep = [], []
    for tolerance in tolerances:
        m = simulate(scene, Moreau(h, theta=theta, tolerance=tolerance))
        assert m.status == Status.DONE
        apart.append(np.max(np.abs(m.at(at)[0] - true)))
        deep.append(np.max(m.penetration, initial=0.0))
    return np.array(apart), np.array(deep), 1.0 + np.max(np.abs(true))


def slope(x, y):
    return np.polyfit(np.log(x), np.log(y), 1)[0]


@pytest.mark.parametrize(
    ("scene", "h", "theta"),
    [
        (oscillator(), 0.5, 0.5),
        (oscillator(), 0.5, 1.0),
        (scenes.cam_follower(rpm=358.0, t_end=1.0), 0.02, 0.5),
        pytest.param(scenes.newtons_cradle(spacing=0.01), 0.1, 0.5, marks=pytest.mark.slow),
        pytest.param(scenes.pendulum_stop(), 0.1, 0.5, marks=pytest.mark.slow),
    ],
    ids=["oscillator", "oscillator-implicit", "cam", "cradle", "pendulum"],
)
def test_errors_follow_the_tolerance(scene, h, theta):
    tolerances = TOLERANCES if theta == 0.5 else TOLERANCES[:3]
    apart, deep, size = errors(scene, h, theta, tolerances)
    assert np.all(apart <= 3.0 * np.array(tolerances) * size)
    assert np.all(deep <= 0.1 * np.array(tolerances) * size)
    if np.max(apart) > 1e-10:  # else steps make no error in this motion
        assert 0.8 < slope(tolerances, apart) < 1.2


def test_a_chattering_ball_comes_to_rest_and_is_right_between_its_steps():
    at = np.linspace(0.0, 5.0, 1001)
    found = []
    for tolerance in TOLERANCES:
        m = simulate(scenes.bouncing_ball(t_end=5.0), Moreau(0.1, tolerance=tolerance))
        assert m.status == Status.DONE
        assert m.impacts.kind[-1] == Kind.STICK
        assert m.v[-1, 0] == 0.0
        assert m.counts.steps == len(m.t) - 1
        assert m.penetration[0] <= 0.1 * tolerance
        found.append(np.max(np.abs(m.at(at)[0][:, 0] - ball_height(1.0, 9.81, 0.8)(at))))
        kept = simulate(scenes.bouncing_ball(t_end=5.0), Moreau(0.1, tolerance=tolerance), keep=at)
        assert np.allclose(kept.q, m.at(at)[0], rtol=0.0, atol=1e-13)
    assert np.all(np.array(found) <= TOLERANCES)
    assert 0.8 < slope(TOLERANCES, found) < 1.2


@pytest.mark.parametrize("late", [1e-3, 4e-3])
def test_who_lands_just_before_the_end_has_bounced_there(late):
    """A depth that the tolerance of positions would allow is an impact that is still to come."""
    struck, tolerance = 1.0 / 1.1, 1e-2
    span = (0.0, struck + late)
    scene = Scene(LinearSystem(1.0), [1.0], [-1.1], span, contacts=LinearContacts([[1.0]], restitution=0.5))
    m = simulate(scene, Moreau(8.0, tolerance=tolerance))
    assert len(m.impacts) == 1
    assert abs(m.impacts.time[0] - struck) < 0.1 * tolerance
    assert m.v[-1, 0] == pytest.approx(0.55, rel=1e-12)
    assert m.q[-1, 0] == pytest.approx(0.55 * late, abs=0.1 * tolerance)
    assert m.penetration[0] < 0.01 * tolerance


def test_a_floor_that_long_steps_fly_through_is_met():
    """Without forces one long step and two agree to the last bit, below the floor as above it."""
    scene = Scene(
        LinearSystem(1.0), [1.0], [-1.1], (0.0, 8.0), contacts=LinearContacts([[1.0]], restitution=0.5)
    )
    for tolerance in TOLERANCES:
        m = simulate(scene, Moreau(8.0, tolerance=tolerance))
        assert np.max(m.penetration) <= 0.1 * tolerance
        assert m.q[-1, 0] == pytest.approx(0.55 * (8.0 - 1.0 / 1.1), abs=tolerance)


def test_fewer_steps_than_steps_of_one_size_for_the_same_error():
    """The cam's corners and impacts ask for short steps, the rest does not."""
    scene = scenes.cam_follower(rpm=358.0, t_end=0.5)
    at = np.linspace(0.0, 0.5, 101)
    true = simulate(scene, EventDriven(), keep=at).q
    adapted = simulate(scene, Moreau(0.02, tolerance=1e-5), keep=at)
    error = np.max(np.abs(adapted.q - true))
    work = adapted.counts.force_evaluations
    even = [simulate(scene, Moreau(0.5 / round(work * s)), keep=at) for s in (1.0, 1.07, 1.13, 1.21, 1.29)]
    assert np.mean([np.max(np.abs(m.q - true)) for m in even]) > 10.0 * error


@pytest.mark.parametrize("h", [0.628, 5.0])
@pytest.mark.parametrize("tolerance", [1e-3, 1e-5])
def test_releases_are_in_time(h, tolerance):
    """A step and its halves let a contact go by the mean of its force, at one time that may be wrong."""
    scene = dataclasses.replace(scenes.sticking_oscillator(), t_span=(0.0, 60.0))
    at = np.linspace(0.0, 60.0, 1601)
    m = simulate(scene, Moreau(h, tolerance=tolerance), keep=at)
    assert np.max(np.abs(m.q - scene.exact(at)[0])) <= tolerance


def along(t, q, v, p, out):
    out[0, 0], out[0, 1] = 1.0, 0.0


def shaken(t, q, v, p, out):
    out[0] = -p[0] * p[1] * np.cos(p[1] * t)


def slid(A, omega, a, t_end, n):
    """Where a block on a table A sin(omega t) is, and how fast: |v'| <= a; sliding by its closed form."""
    t, q, v, h = 0.0, 0.0, 0.0, t_end / n
    for k in range(n):
        t = k * h
        table = A * omega * np.cos(omega * (t + h))
        change = min(max(table - v, -a * h), a * h)
        q, v = q + h * (v + 0.5 * change), v + change
    return q


@pytest.mark.parametrize("h", [0.01, 0.1, 0.5])
def test_friction_that_turns_or_gives_way_is_seen(h):
    """A block on a table shaken along: every step and its halves agreed, and drifted by 2.4e-3 m."""
    friction = Coulomb(mu=0.3, tangent=along, slip=shaken)
    scene = Scene(
        LinearSystem(np.eye(2), force=[0.0, -9.81]), [0.0, 0.0], [0.0, 0.0], (0.0, 3.0),
        LinearContacts([[0.0, 1.0]], restitution=0.0, friction=friction), p=[0.02, 20.0],
    )  # fmt: skip
    true = slid(0.02, 20.0, 0.3 * 9.81, 3.0, 200_000)
    for tolerance in TOLERANCES:
        m = simulate(scene, Moreau(h, tolerance=tolerance))
        assert m.status == Status.DONE
        assert abs(m.q[-1, 0] - true) <= 3.0 * tolerance


def test_kept_states_are_a_choice():
    full = simulate(oscillator(), Moreau(0.5, tolerance=1e-3))
    third = simulate(oscillator(), Moreau(0.5, tolerance=1e-3), keep=3)
    assert np.array_equal(third.q[:100], full.q[:300:3])
    assert np.array_equal(third.impacts, full.impacts)
    assert np.sum(third.impulse) == pytest.approx(np.sum(full.impulse), rel=1e-12)
    steps = np.diff(full.t)
    assert steps.max() <= 0.25
    assert steps.min() < 1e-4 * steps.max()
    struck = simulate(oscillator(), Moreau(0.5, tolerance=1e-3), keep="impacts")
    assert set(struck.t[1:-1]) == set(full.impacts.time)


def test_an_interruption_loses_nothing():
    full = simulate(oscillator(), Moreau(0.5, tolerance=1e-6))

    def stop(t):
        raise KeyboardInterrupt

    with pytest.raises(SimulationInterrupted) as stopped:
        simulate(oscillator(), Moreau(0.5, tolerance=1e-6), progress=stop)
    part = stopped.value.trajectory
    n = len(part.t)
    assert 100 < n < len(full.t)
    assert np.array_equal(part.t, full.t[:n])
    assert np.array_equal(part.q, full.q[:n])


def test_a_tolerance_that_cannot_be_met_ends_the_run():
    m = simulate(oscillator(), Moreau(0.5, tolerance=1e-17))
    assert m.status == Status.STEP_TOO_SMALL
    assert "tolerance" in m.message


def fading(t, q, v, p, out):
    out[0, 0] = 1.0 - q[0]


def pushing(t, q, v, p, out):
    out[0] = 1.0


def test_a_mass_that_vanishes_is_named():
    """(1 - q) q'' = 1 has no motion beyond q = 1."""
    system = System(n_q=1, mass=fading, force=pushing)
    m = simulate(Scene(system, q0=[0.0], v0=[1.0], t_span=(0.0, 3.0)), Moreau(0.1, tolerance=1e-3))
    assert m.status == Status.STEP_TOO_SMALL
    assert "tolerance" in m.message
    assert "mass" in m.message


@pytest.mark.parametrize("bad", [0.0, -1.0, np.nan, "small"])
def test_bad_tolerances_are_named(bad):
    with pytest.raises(ValueError, match="tolerance"):
        Moreau(0.1, tolerance=bad)


def test_what_takes_steps_of_one_size_only_says_so():
    with pytest.raises(LcpStepError, match="lemke"):
        Moreau(0.1, lcp="qp", tolerance=1e-4)
    many = LinearSystem(sparse.eye_array(3000))
    with pytest.raises(LcpStepError, match="sparse"):
        simulate(Scene(many, np.ones(3000), np.zeros(3000), (0.0, 1.0)), Moreau(0.1, tolerance=1e-4))


@pytest.mark.slow
def test_friction_in_a_mechanism_is_adapted_too():
    scene = scenes.slider_crank(t_end=0.05)
    fine = simulate(scene, Moreau(0.05 / 200_000), keep=np.linspace(0.0, 0.05, 26)).q
    found = []
    for tolerance in TOLERANCES[:3]:
        m = simulate(scene, Moreau(0.01, tolerance=tolerance), keep=np.linspace(0.0, 0.05, 26))
        assert m.status == Status.DONE
        found.append(np.max(np.abs(m.q - fine)))
    assert np.all(np.array(found) <= 3.0 * np.array(TOLERANCES[:3]) * (1.0 + np.max(np.abs(fine))))


def sunk(t, q, v, p, out):
    """A table that sinks by p[0] from time p[1] to p[2], and is still before and after."""
    x = min(1.0, max(0.0, (t - p[1]) / (p[2] - p[1])))
    out[0, 0] = -p[0] * x * x * (3.0 - 2.0 * x)
    out[0, 1] = -p[0] * 6.0 * x * (1.0 - x) / (p[2] - p[1])
    out[0, 2] = -p[0] * (6.0 - 12.0 * x) / (p[2] - p[1]) ** 2 if 0.0 < x < 1.0 else 0.0


@pytest.mark.parametrize("span", [1.0, 3.0])
@pytest.mark.parametrize("begins", [1.75, 1.7, 1.64])
@pytest.mark.parametrize("tolerance", [1e-2, 1e-3, 1e-4])
def test_a_table_that_sinks_between_two_looks_leaves_what_lay_on_it(tolerance, begins, span):
    """Its speed is zero at both, and so is that of the body, which a spring and its weight press onto it."""
    ends = begins + 0.125
    scene = Scene(
        LinearSystem(0.5, K=64.0, force=-2.0), 0.0, 0.0, (0.0, 3.0),
        LinearContacts(1.0, 0.0, 0.0, motion=sunk), p=[0.4375, begins, ends], corners=[begins, ends],
    )  # fmt: skip
    m = simulate(scene, Moreau(span, tolerance=tolerance))
    assert m.status == Status.DONE
    since = np.maximum(m.t - begins, 0.0)  # it swings about -2 / 64 with sqrt(128) rad/s
    np.testing.assert_allclose(
        m.q[:, 0], -(1.0 - np.cos(np.sqrt(128.0) * since)) / 32.0, rtol=0, atol=tolerance
    )


@pytest.mark.parametrize("tolerance", [1e-3, 1e-4, 1e-5])
def test_a_projection_hides_no_depth(tolerance):
    """A step that ends deep in the floor would be put back onto it, as if the impact had come on time."""
    ball = scenes.bouncing_ball(t_end=1.0)
    t = np.linspace(0.05, 0.95, 19)
    m = simulate(ball, Moreau(0.1, tolerance=tolerance, projected=True), keep=t)
    np.testing.assert_allclose(m.q, ball.exact(t)[0], rtol=0, atol=tolerance)
