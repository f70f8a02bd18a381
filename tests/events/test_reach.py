"""How far a moving obstacle reaches, and flights that cross its corners in one leap under that bound."""

from functools import partial

import numpy as np
import pytest

from lagrangian import LinearContacts, LinearSystem, Scene
from lagrangian.scenes import cam_follower
from lcpstep import EventDriven, Kind, simulate
from lcpstep.events.flight.reach import reach
from lcpstep.model import model

PULSE = (0.61, 0.6102)  # of the period: between these a tooth rises and sinks


def tooth(t, q, v, p, out):
    x = (t - np.floor(t) - PULSE[0]) / (PULSE[1] - PULSE[0])
    rate = np.pi / (PULSE[1] - PULSE[0])
    inside = 0.0 < x < 1.0
    out[0, 0] = p[0] * np.sin(np.pi * x) ** 2 if inside else 0.0
    out[0, 1] = p[0] * rate * np.sin(2.0 * np.pi * x) if inside else 0.0
    out[0, 2] = 2.0 * p[0] * rate**2 * np.cos(2.0 * np.pi * x) if inside else 0.0


def rising(t, q, v, p, out):
    tooth(t, q, v, p, out)
    out[0, 0] += 0.01 * t
    out[0, 1] += 0.01


def above(motion, height=0.4):
    return Scene(
        system=LinearSystem(1.0, force=-10.0), contacts=LinearContacts(1.0, restitution=0.5, motion=motion),
        q0=0.1, v0=3.0, t_span=(0.0, 3.0), p=[height], corners=(PULSE[0], 0.6101, PULSE[1]), period=1.0,
    )  # fmt: skip


@pytest.mark.parametrize("coordinates", ["relative", "absolute"])
@pytest.mark.parametrize("rpm", [125.0, 700.0])
def test_the_cam_stays_below_its_reach(rpm, coordinates):
    scene = cam_follower(rpm=rpm, coordinates=coordinates)
    seen = reach(scene, model(scene))
    f = scene.system.frame or scene.contacts.motion
    now = np.zeros((20_000, 1, 3))
    for t, out in zip(np.linspace(0.0, scene.period, len(now)), now, strict=True):
        f(t, scene.q0, scene.v0, scene.p, out)
    assert np.max(now[:, 0, 0]) < seen.clear < np.max(now[:, 0, 0]) + 0.02
    assert np.max(np.abs(now[:, 0, 2])) < seen.bend
    assert seen.size == pytest.approx(np.max(np.abs(now[:, 0, 0])), rel=1e-3)
    assert seen.speed == pytest.approx(np.max(np.abs(now[:, 0, 1])), rel=1e-2)


def test_a_tooth_between_near_corners_is_seen_and_struck():
    scene = above(tooth)
    assert reach(scene, model(scene)).clear > 0.4
    # It meets the mass in the middle of its flight, which would touch the floor at 0.631 s only
    first = simulate(scene, EventDriven()).impacts[0]
    assert PULSE[0] < first.time < PULSE[1]
    free = simulate(above(tooth, height=0.0), EventDriven()).impacts[0]
    assert free.time == pytest.approx(0.3 + np.sqrt(0.09 + 0.02), abs=1e-14)


def test_an_obstacle_that_does_not_repeat_has_no_reach():
    scene = above(rising)
    assert reach(scene, model(scene)).clear == np.inf


def test_states_within_a_leap_are_those_of_the_free_motion():
    make = partial(cam_follower, rpm=700.0, q0=1.0, v0=60.0, t_end=0.03)  # above the whole cam at once
    wanted = np.linspace(0.0, 0.03, 101)
    run = simulate(make(), EventDriven())
    assert len(run.impacts) == 0
    assert len(run.t) <= 3
    q, v = make().exact(wanted)
    np.testing.assert_allclose(run.at(wanted)[0], q, rtol=0.0, atol=1e-13)
    kept = simulate(make(), EventDriven(), keep=wanted)
    np.testing.assert_allclose(kept.q, q, rtol=0.0, atol=1e-13)
    np.testing.assert_allclose(kept.v, v, rtol=0.0, atol=1e-11)


HEIGHT = 0.0


def raised(t, q, v, p, out):
    out[0, 0] = HEIGHT * (1.0 - np.cos(2.0 * np.pi * t))
    out[0, 1] = HEIGHT * 2.0 * np.pi * np.sin(2.0 * np.pi * t)
    out[0, 2] = HEIGHT * 4.0 * np.pi**2 * np.cos(2.0 * np.pi * t)


@pytest.mark.parametrize("plain", [False, True])
def test_a_table_is_looked_at_again_when_its_height_has_changed(plain, monkeypatch):
    """In a scene that stays the same object; the flight would pass over it, with the bounds of before."""
    if plain:
        monkeypatch.setenv("NUMBA_DISABLE_JIT", "1")
    scene = above(raised)
    low = simulate(scene, EventDriven()).impacts[0]
    monkeypatch.setattr(f"{__name__}.HEIGHT", 0.2)
    high = simulate(scene, EventDriven())
    assert 0.1 + 3.0 * low.time - 5.0 * low.time**2 == pytest.approx(0.0, abs=1e-12)
    t = high.impacts[0].time
    assert t < low.time - 0.01
    assert 0.1 + 3.0 * t - 5.0 * t**2 == pytest.approx(0.2 * (1.0 - np.cos(2.0 * np.pi * t)), abs=1e-12)
    assert np.array_equal(high.t, simulate(above(raised), EventDriven()).t)


def to_and_fro(t, q, v, p, out):
    """A table, or a frame, that rises for half a period with 0.4 m/s, and falls for the other."""
    since = t - 0.3 * np.floor(t / 0.3)
    rises = since < 0.15
    out[0, 0] = 0.4 * (since if rises else 0.3 - since)
    out[0, 1] = 0.4 if rises else -0.4
    out[0, 2] = 0.0


def strikes(height, restitution, t_end):
    """Times at which a ball meets that table: roots of a quadratic in every half of a period."""
    found, t, x, v, half = [], 0.0, height, 0.0, -1
    while t < t_end:
        half += 1
        end, w = min(0.15 * (half + 1), t_end), 0.4 if half % 2 == 0 else -0.4
        while t < end:
            g, u = x - (0.06 * (half % 2) + w * (t - 0.15 * half)), v - w
            meets = t + (u + np.sqrt(u * u + 2.0 * 9.81 * max(g, 0.0))) / 9.81
            step = min(meets, end) - t
            t, x, v = min(meets, end), x + v * step - 0.5 * 9.81 * step**2, v - 9.81 * step
            if t == meets:
                found.append(t)
                v = w - restitution * (v - w)
    return np.array(found)


@pytest.mark.parametrize("moved", ["table", "frame"])
@pytest.mark.parametrize("corners", [(0.0, 0.15), ()])
def test_no_leap_from_a_low_hop_crosses_a_corner_at_which_the_table_jumps(corners, moved):
    """The table falls as the ball leaves it, and rises to meet it: the ball passed through it."""
    frame, motion, v0 = (to_and_fro, None, -0.4) if moved == "frame" else (None, to_and_fro, 0.0)
    scene = Scene(
        LinearSystem(1.0, force=-9.81, frame=frame), 0.5, v0, (0.0, 2.8),
        LinearContacts(1.0, restitution=0.5, motion=motion), corners=corners, period=0.3,
    )  # fmt: skip
    struck = simulate(scene, EventDriven()).impacts
    wanted = strikes(0.5, 0.5, 2.8)
    assert 2.7 < wanted[9] < 2.72
    np.testing.assert_allclose(struck.time[struck.kind == Kind.IMPACT], wanted, rtol=0.0, atol=1e-12)
