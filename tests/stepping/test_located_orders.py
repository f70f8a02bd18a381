"""Located impacts with smooth motion of order four, and exact."""

import math

import numpy as np
import pytest

from lagrangian import LinearContacts, LinearSystem, Scene, scenes
from lcpstep import EventDriven, Kind, LcpStepError, Located, simulate
from tests.known import SPREAD, ball_height
from tests.models import ball_on_table, bowl_scene, pendulum
from tests.stepping.test_located import double_pendulum
from tests.stepping.test_located_several import over_a_moving_hollow, tonks
from tests.stepping.test_order import slope
from tests.stepping.test_several_contacts import line

OSCILLATOR = scenes.impact_oscillator(t_end=20.0)
STICKING = scenes.impact_oscillator(omega=0.25, amplitude=2.0, stop=0.5, restitution=0.6, t_end=60.0)
TABLE = ball_on_table(0.01, 40.0, 0.3, 0.02, 0.0, 2.0)

FOURTH = [
    pytest.param(OSCILLATOR, (50, 200, 800, 3200, 12800), id="impact oscillator"),
    pytest.param(STICKING, (50, 200, 800, 3200, 12800), id="chattering, sticking, release"),
    pytest.param(double_pendulum(3.0), (100, 400, 1600, 6400), id="double pendulum"),
    pytest.param(
        scenes.cam_follower(t_end=0.35, coordinates="absolute"), (50, 200, 800, 3200), id="moving cam"
    ),
    pytest.param(pendulum(1.0, 0.5, 10.0), (50, 200, 800, 3200), id="pendulum"),
    pytest.param(bowl_scene([0.5, -0.2], [0.0, 0.0], 2.0), (50, 100, 200, 400), id="bowl"),
]


@pytest.mark.parametrize(("scene", "levels"), FOURTH)
def test_order_four_through_impacts(scene, levels):
    reference, span = simulate(scene, EventDriven()), np.ptp(scene.t_span)
    at, errors = np.linspace(*scene.t_span, 200), []
    q, _ = reference.at(at)
    for n in levels:
        runs = [simulate(scene, Located(span / round(n * s), order=4), keep=at) for s in SPREAD[:3]]
        errors.append(np.mean([np.max(np.abs(m.q - q)) for m in runs]))
    # below 1e-11 rounding decides, magnified by the impacts
    usable = np.array(errors) > 1e-11
    assert np.sum(usable) >= 3
    assert slope(np.array(levels)[usable], np.array(errors)[usable]) >= 3.8


EXACT = [
    OSCILLATOR,
    STICKING,
    TABLE,
    scenes.cam_follower(t_end=0.35),
    scenes.cam_follower(t_end=0.35, coordinates="absolute"),
    scenes.cam_follower(rpm=120.0, t_end=2.0),
]


@pytest.mark.parametrize("scene", EXACT, ids=lambda s: s.name)
@pytest.mark.parametrize("steps", [13, 100, 1000])
def test_exact_motion_is_exact_at_any_step(scene, steps):
    at = np.linspace(*scene.t_span, 333)
    q, v = simulate(scene, EventDriven()).at(at)
    m = simulate(scene, Located(np.ptp(scene.t_span) / steps, order="exact"), keep=at)
    np.testing.assert_allclose(m.q, q, rtol=0, atol=1e-12)
    np.testing.assert_allclose(m.v, v, rtol=0, atol=1e-9)


@pytest.mark.parametrize("order", [4, "exact"])
def test_sticking_and_release_times(order):
    m = simulate(TABLE, Located(1e-3, order=order))
    release = m.impacts[m.impacts.kind == Kind.RELEASE].time * 40.0 % (2 * math.pi)
    assert len(release) >= 12
    np.testing.assert_allclose(release, math.asin(9.81 / 16.0), rtol=0, atol=1e-10)
    m = simulate(STICKING, Located(0.02 if order == 4 else 0.3, order=order))
    release = m.impacts[m.impacts.kind == Kind.RELEASE].time * 0.25 % (2 * math.pi)
    # the contact force 2 cos(phase) - 0.5 vanishes
    np.testing.assert_allclose(2 * np.cos(release), 0.5, rtol=0, atol=1e-9)
    exact = simulate(STICKING, EventDriven()).impacts
    stick = m.impacts[m.impacts.kind == Kind.STICK].time
    np.testing.assert_allclose(stick, exact[exact.kind == Kind.STICK].time, rtol=0, atol=1e-8)


@pytest.mark.parametrize("order", [4, "exact"])
@pytest.mark.parametrize("h", [1e-2, 0.37, 5.0])
def test_the_ball_is_exact_in_every_order(order, h):
    m = simulate(scenes.bouncing_ball(), Located(h, order=order))
    np.testing.assert_allclose(m.q[:, 0], ball_height(1.0, 9.81, 0.8)(m.t), rtol=0, atol=1e-13)
    assert m.v[-1, 0] == 0.0
    assert np.min(m.q) > -1e-14
    assert np.sum(m.impulse) == pytest.approx(9.81 * 5.0, rel=1e-12)


@pytest.mark.parametrize("order", [4, "exact"])
def test_several_contacts_in_every_order(order):
    scene, exact = tonks(8, 5.0)
    m = simulate(scene, Located(0.07, order=order))
    np.testing.assert_allclose(m.q[-1], exact(5.0), rtol=0, atol=1e-11)
    cradle = simulate(line([0.0, 0.0, 0.0], [1.0, 0.0, 0.0], 1.0, t_end=0.1), Located(1e-2, order=order))
    np.testing.assert_allclose(cradle.v[-1], [-1 / 3, 2 / 3, 2 / 3], rtol=0, atol=1e-14)
    n = 5
    column = line(0.05 * np.arange(1, n + 1), np.zeros(n), 0.5, walls=True, force=-9.81, t_end=2.0)
    m = simulate(column, Located(1e-2, order=order))
    assert np.max(np.abs(m.v[-1])) < 1e-14
    assert np.max(np.abs(m.q[-1])) < 1e-13
    assert np.min(m.q @ column.contacts.G.T) > -1e-13
    np.testing.assert_allclose(m.impulse[-1] / 1e-2, 9.81 * np.arange(n, 0, -1), rtol=1e-10)


def chain(order, n=6):
    """Elastic chain that lands on a wall, stays and leaves again."""
    K = 1e3 * (2 * np.eye(n) - np.eye(n, k=1) - np.eye(n, k=-1))
    K[0, 0] = K[-1, -1] = 1e3
    scene = Scene(
        system=LinearSystem(M=np.eye(n), K=K, C=1e-3 * K),
        contacts=LinearContacts(G=np.eye(n)[:1], restitution=0.0),
        q0=np.full(n, 0.01), v0=np.full(n, -1.0), t_span=(0.0, 0.6),
    )  # fmt: skip
    at = np.linspace(0.0, 0.6, 50)
    return simulate(scene, Located(1e-2 if order == "exact" else 1e-4, order=order), keep=at)


def test_exact_motion_of_several_coordinates():
    exact, fine = chain("exact"), chain(4)
    assert np.any(exact.impacts.kind == Kind.RELEASE)
    np.testing.assert_array_equal(exact.impacts.kind, fine.impacts.kind)
    np.testing.assert_allclose(exact.impacts.time, fine.impacts.time, rtol=0, atol=1e-9)
    np.testing.assert_allclose(exact.q, fine.q, rtol=0, atol=1e-9)
    # the wall turns the momentum of six masses around, less what damping and plastic impacts keep
    np.testing.assert_allclose(np.sum(exact.impulse), np.sum(exact.v[-1]) + 6.0, rtol=1e-10)


def test_states_at_any_time_come_from_another_run():
    m, at = simulate(OSCILLATOR, Located(0.3, order="exact")), [7.77, 0.0, 20.0, 7.77]
    np.testing.assert_allclose(m.at(at)[0], simulate(OSCILLATOR, EventDriven()).at(at)[0], rtol=0, atol=1e-12)


def test_what_is_not_known_in_closed_form_is_refused():
    with pytest.raises(LcpStepError, match=r"all but a LinearSystem .* take order=4"):
        simulate(double_pendulum(1.0), Located(1e-2, order="exact"))
    with pytest.raises(LcpStepError, match="other contacts than LinearContacts"):
        simulate(bowl_scene([0.5, -0.2], [0.0, 0.0], 2.0), Located(1e-2, order="exact"))
    for order in (3, "4", 2.0, True):
        with pytest.raises(ValueError, match=r"^order: expected"):
            Located(1e-2, order=order)


def test_curved_moving_obstacles_with_order_four():
    scene = over_a_moving_hollow(0.6, 2.0)
    at = np.linspace(0.0, 2.0, 50)
    fine = simulate(scene, Located(1e-4, order=4), keep=at)
    levels, errors = (20, 40, 80, 160, 320), []
    for n in levels:
        m = simulate(scene, Located(2.0 / n, order=4), keep=at)
        errors.append(np.max(np.abs(m.q - fine.q)))
        gaps = [np.min(scene.gap(t, q, v)[0]) for t, q, v in zip(m.t, m.q, m.v, strict=True)]
        assert min(gaps) > -1e-12
    assert slope(levels, errors) >= 3.5 or errors[-1] < 1e-10
