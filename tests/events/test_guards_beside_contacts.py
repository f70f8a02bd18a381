"""Guards and resets of systems with contacts: at impacts, at rest, at the start; what goes wrong is named."""

import math
from dataclasses import replace

import numpy as np
import pytest

from lagrangian import Guard, HybridScene, HybridSystem, LinearContacts, Mode
from lcpstep import EventDriven, Kind, SimulationError, Status, simulate
from tests.events.switching import (
    FLOOR,
    METHOD,
    above,
    ball,
    bilinear_with_wall,
    falls,
    falls_otherwise,
    later,
    left,
    soft,
    stiff,
    two_gravities,
)


def upwards(t, x, p, out):
    out[0] = x[1]


def at_the_floor(t, x, p, out):
    out[0] = -x[0]


def thrown_up(t, x, p, out):
    out[0], out[1] = 2.0, 0.0


def thrown_down(t, x, p, out):
    out[0], out[1] = -1.0, 0.0


# --------------------------------------------------------------------------- guards and impacts


@pytest.mark.parametrize("at_once", [True, False])
def test_a_guard_that_an_impact_carries_through_zero_acts_at_the_impact(at_once):
    modes = {
        "down": Mode(falls, [Guard(upwards, "up", at_once=at_once)]),
        "up": Mode(falls, [Guard(upwards, "down", direction=-1)]),
    }
    run = simulate(ball(modes, "down", [1.0, -0.1], 1.5, [9.81]), METHOD)
    hits = run.impacts.time[run.impacts.kind == Kind.IMPACT]
    assert len(hits) >= 2
    np.testing.assert_array_equal(run.switches.time[run.switches.target == "up"], hits)
    first = run.switches[0]
    assert first.before[1] == run.impacts.after[0]
    tops = hits + run.impacts.after / 9.81
    down = run.switches.time[run.switches.target == "down"]
    np.testing.assert_allclose(down, tops[: len(down)], rtol=0, atol=1e-11)


def test_a_guard_on_the_obstacle_acts_with_the_impact():
    modes = {"a": Mode(falls, [Guard(at_the_floor, "b", at_once=False)]), "b": Mode(falls_otherwise)}
    run = simulate(ball(modes, "a", [1.0, 0.0], 1.0, [9.81, 2.0]), METHOD)
    falls_for = math.sqrt(2.0 / 9.81)
    assert len(run.switches) == 1
    np.testing.assert_allclose([run.switches.time[0], run.impacts.time[0]], falls_for, rtol=0, atol=1e-12)
    assert run.impacts.after[0] == pytest.approx(0.7 * 9.81 * falls_for, abs=1e-11)
    assert run.impacts.time[1] - falls_for == pytest.approx(
        2.0 * run.impacts.after[0] / (2.0 * 9.81), abs=1e-11
    )


def test_a_reset_takes_a_resting_body_off_the_floor():
    modes = {"down": Mode(falls, [Guard(later, "again", reset=thrown_up)]), "again": Mode(falls)}
    run = simulate(ball(modes, "down", [0.0, 0.0], 1.5, [9.81, 1.0, 0.5]), METHOD)
    assert list(run.impacts.kind) == [Kind.STICK, Kind.RELEASE, Kind.IMPACT]
    np.testing.assert_allclose(run.impacts.time[1:], [0.5, 0.5 + math.sqrt(4.0 / 9.81)], rtol=0, atol=1e-11)
    np.testing.assert_array_equal(run.switches.after[0], [2.0, 0.0])
    np.testing.assert_array_equal(run.at(run.switches.time[0]), [2.0, 0.0])


def to_the_start(t, x, p, out):
    out[0], out[1] = 1.0, 0.0


def test_a_reset_at_an_impact_leaves_no_contact_closed_where_the_body_no_longer_is():
    """Springs push off the wall; the rebound carries the guard through zero, which sets the motion back."""
    modes = {
        "right": Mode(soft, [Guard(left, "left")]),
        "left": Mode(stiff, [Guard(upwards, "right", reset=to_the_start)]),
    }
    lap = 0.5 * math.pi + 0.5 * math.asin(0.6)
    run = simulate(
        replace(bilinear_with_wall(3.3 * lap), system=HybridSystem(2, modes, mass=[[0.5]])), METHOD
    )
    np.testing.assert_allclose(run.impacts.time, lap * np.arange(1, 4), rtol=0, atol=1e-10)
    np.testing.assert_allclose(
        run.at(3.3 * lap), [math.cos(0.3 * lap), -math.sin(0.3 * lap)], rtol=0, atol=1e-10
    )


def unchanged(t, x, p, out):
    out[0], out[1] = x[0], x[1]


@pytest.mark.parametrize("speed", [1e-2, -1e-2])
def test_a_reset_within_a_low_hop_leaves_the_hop_its_height(speed):
    """Lower than the tolerance of places, by 1e-6: it lands with the speed that its whole height gives."""
    place = 9e-7
    modes = {"down": Mode(falls, [Guard(later, "again", reset=unchanged)]), "again": Mode(falls)}
    t = 5e-5
    x = [place - t * speed, speed]
    table = LinearContacts([[1.0]], restitution=1.0)
    run = simulate(ball(modes, "down", x, 3e-3, [9.81, 1.0, t], table), EventDriven(1e-6, 1e-6))
    hits = run.impacts[run.impacts.kind == Kind.IMPACT]
    assert len(run.switches) == 1
    assert hits.before[0] == pytest.approx(-math.sqrt(speed * speed + 2.0 * 9.81 * x[0]), rel=1e-3)


def test_a_reset_that_leads_into_the_obstacle_is_named():
    modes = {"down": Mode(falls, [Guard(later, "deep", reset=thrown_down)]), "deep": Mode(falls)}
    run = simulate(ball(modes, "down", [0.0, 0.0], 1.5, [9.81, 1.0, 0.5]), METHOD)
    assert run.status == Status.PROJECTION_FAILED
    assert "reset of the switch to mode 'deep' leads inside the obstacle of contact 0" in run.message
    assert run.t[-1] == pytest.approx(0.5, abs=1e-12)


def test_a_mode_whose_guard_is_passed_at_the_start_is_left_at_once():
    modes = {"down": Mode(falls, [Guard(above, "low")]), "low": Mode(falls_otherwise)}
    run = simulate(ball(modes, "down", [1.0, 0.0], 0.3, [9.81, 2.0, 0.4]), METHOD)
    assert run.switches.time[0] == 0.0
    assert run.at(0.3)[0] == pytest.approx(1.0 - 9.81 * 0.09, abs=1e-12)


def test_modes_that_follow_one_another_for_ever_are_named():
    modes = {"a": Mode(falls, [Guard(above, "b")]), "b": Mode(falls, [Guard(above, "a")])}
    run = simulate(ball(modes, "a", [1.0, 0.0], 0.3, [9.81, 2.0, 0.4]), METHOD)
    assert run.status == Status.ENDLESS_SWITCHING
    assert "b -> a" in run.message or "a -> b" in run.message


def test_a_guard_that_is_only_touched_is_named():
    modes = {"a": Mode(falls, [Guard(above, "b", at_once=False)]), "b": Mode(falls)}
    top = 0.5 + 2.0**2 / (2.0 * 9.81)
    run = simulate(ball(modes, "a", [0.5, 2.0], 1.0, [9.81, 2.0, top]), METHOD)
    assert run.status == Status.NOT_TRANSVERSAL
    assert "touches the guard towards 'b'" in run.message


def test_events_of_both_kinds_count():
    run = simulate(two_gravities(), EventDriven(max_events=5))
    assert run.status == Status.TOO_MANY_EVENTS
    assert len(run.switches) + len(run.impacts) <= 7


# --------------------------------------------------------------------------- bad input


def wrong_order(t, x, p, out):
    out[0], out[1] = -p[0], x[1]


def nothing_after_a_while(t, x, p, out):
    out[0], out[1] = x[1], math.nan if t > 0.2 else -p[0]


def test_bad_input_is_named():
    modes = {"down": Mode(falls)}

    def scene(contacts=FLOOR, mass=1.0, x0=(1.0, 0.0), modes=modes):
        return HybridScene(
            HybridSystem(2, modes, mass=mass), x0, "down", (0.0, 1.0), p=[9.81], contacts=contacts
        )

    for expected, error, make in (
        ("contacts: expected a system with a mass matrix", ValueError, lambda: scene(mass=None)),
        ("mass: .*positive definite", ValueError, lambda: scene(mass=-1.0)),
        ("mass: expected shape", ValueError, lambda: scene(mass=np.eye(2))),
        ("n_x: expected an even number", ValueError, lambda: HybridSystem(3, modes, mass=np.eye(1))),
        ("x0: the initial state lies inside", ValueError, lambda: scene(x0=(-0.1, 0.0))),
        ("contacts.G: expected 1 columns", ValueError, lambda: scene(LinearContacts([[1.0, 0.0]]))),
        ("contacts: expected", TypeError, lambda: scene([[1.0]])),
        (r"field of mode 'down': expected \(v, v'\)", ValueError, lambda: scene(modes={"down": Mode(wrong_order)})),
    ):  # fmt: skip
        with pytest.raises(error, match=expected):
            make()


def test_a_field_that_fails_on_the_way_ends_the_run_with_its_name():
    with pytest.raises(SimulationError, match="mode 'down'"):
        simulate(ball({"down": Mode(nothing_after_a_while)}, "down", [1.0, 0.0], 1.0, [9.81]), METHOD)
