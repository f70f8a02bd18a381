"""Systems with modes whose contacts have friction, against closed forms and the same motion without modes."""

import math

import numpy as np
import pytest

from lagrangian import Coulomb, Guard, HybridScene, HybridSystem, LinearContacts, Mode, Scene, System
from lcpstep import EventDriven, Kind, Status, simulate

WEIGHT = 10.0
FLOOR = LinearContacts([[0.0, 1.0]], friction=Coulomb(0.3, [[1.0, 0.0]], mu_s=0.4))


def pulled(t, x, p, out):
    out[0], out[1], out[2], out[3] = x[2], x[3], p[0], -10.0


def left_alone(t, x, p, out):
    out[0], out[1], out[2], out[3] = x[2], x[3], 0.0, -10.0


def beyond(t, x, p, out):
    out[0] = x[0] - 1.0


def late(t, x, p, out):
    out[0] = t - p[1]


def slowly(t, x, p, out):
    out[0] = p[2] - x[2]


def block(modes, mode, x0, t_end, p, contacts=FLOOR):
    system = HybridSystem(4, modes, mass=np.eye(2))
    return HybridScene(system, x0, mode, (0.0, t_end), p=p, contacts=contacts)


def kinds(run):
    return [Kind(k).name for k in run.impacts.kind]


def test_a_block_that_is_pulled_up_to_a_place_comes_to_rest_beyond_it():
    """5 N against 3 N of friction: x = t^2 up to x = 1, where v = 2; from there friction alone, 2^2 / (2 * 3) m."""
    modes = {"pulled": Mode(pulled, [Guard(beyond, "alone")]), "alone": Mode(left_alone)}
    run = simulate(block(modes, "pulled", [0.0, 0.0, 0.0, 0.0], 3.0, [5.0]), EventDriven())
    assert run.status == Status.DONE
    np.testing.assert_allclose(run.switches.time, [1.0], rtol=0, atol=1e-12)
    assert run.x[-1] == pytest.approx([1.0 + 2.0 / 3.0, 0.0, 0.0, 0.0], abs=1e-11)
    stick = run.impacts[run.impacts.kind == Kind.STICK_TANGENT]
    np.testing.assert_allclose(stick.time, [1.0 + 2.0 / 3.0], rtol=0, atol=1e-11)
    assert run.impulse.sum() == pytest.approx(WEIGHT * 3.0, rel=1e-12)
    assert run.friction_impulse.sum() == pytest.approx(-5.0 * 1.0, rel=1e-11)


@pytest.mark.parametrize(("pull", "slides"), [(3.5, False), (4.5, True)])
def test_a_switch_lets_a_block_slide_that_its_new_force_moves(pull, slides):
    """At rest up to mu_s = 0.4 of its weight, slowed by mu = 0.3 of it."""
    modes = {"alone": Mode(left_alone, [Guard(late, "pulled")]), "pulled": Mode(pulled)}
    run = simulate(block(modes, "alone", [0.0, 0.0, 0.0, 0.0], 2.0, [pull, 0.7]), EventDriven())
    assert run.status == Status.DONE
    way = 0.5 * (pull - 3.0) * 1.3**2 if slides else 0.0
    assert run.x[-1, 0] == pytest.approx(way, abs=1e-12)
    assert ("SLIP" in kinds(run)) == slides


def test_a_guard_of_the_sliding_velocity_acts_before_the_block_has_come_to_rest():
    """It is pulled on whenever it is slower than 0.5: from then on uniformly accelerated."""
    modes = {"alone": Mode(left_alone, [Guard(slowly, "pulled")]), "pulled": Mode(pulled)}
    run = simulate(block(modes, "alone", [0.0, 0.0, 2.0, 0.0], 1.5, [7.0, 0.0, 0.5]), EventDriven())
    np.testing.assert_allclose(run.switches.time, [0.5], rtol=0, atol=1e-12)
    assert run.x[-1, 2] == pytest.approx(0.5 + 4.0 * 1.0, abs=1e-11)
    assert "STICK_TANGENT" not in kinds(run)


def thrown(t, x, p, out):
    out[0], out[1], out[2], out[3] = x[2], x[3], 3.0 * math.sin(2.0 * t) - x[0], -10.0


def thrown_force(t, q, v, p, out):
    out[0], out[1] = 3.0 * math.sin(2.0 * t) - q[0], -10.0


def test_with_one_mode_a_scene_with_friction_is_what_it_is_without_modes():
    """A block that hops, chatters, slides, sticks and slips again."""
    contacts = LinearContacts([[0.0, 1.0]], restitution=0.6, friction=Coulomb(0.25, [[1.0, 0.0]]))
    x0 = [0.3, 0.5, 1.0, 0.0]
    one = simulate(block({"only": Mode(thrown)}, "only", x0, 12.0, [], contacts), EventDriven())
    plain = Scene(System(2, np.eye(2), thrown_force), x0[:2], x0[2:], (0.0, 12.0), contacts)
    other = simulate(plain, EventDriven())
    assert {"IMPACT", "ACCUMULATION", "STICK_TANGENT", "SLIP"} <= set(kinds(other))
    np.testing.assert_array_equal(one.impacts.kind, other.impacts.kind)
    np.testing.assert_allclose(one.impacts.time, other.impacts.time, rtol=0, atol=1e-10)
    t = np.linspace(0.0, 12.0, 301)
    np.testing.assert_allclose(one.at(t), np.hstack(other.at(t)), rtol=0, atol=1e-10)
    np.testing.assert_allclose(one.friction_impulse.sum(), other.friction_impulse.sum(), rtol=0, atol=1e-9)


def upwards(t, x, p, x_new):
    x_new[0], x_new[1], x_new[2], x_new[3] = x[0], 0.2, x[2], 0.0


def test_a_reset_that_lifts_a_sliding_block_lets_it_fall_and_slide_on():
    """It slides freely at 2 - 3 t, is lifted by 0.2 at t = 0.4, falls for 0.2 s and lands without restitution.

    The landing takes mu times 2 m/s from its sliding velocity of 0.8.
    """
    modes = {"before": Mode(left_alone, [Guard(late, "after", reset=upwards)]), "after": Mode(left_alone)}
    run = simulate(block(modes, "before", [0.0, 0.0, 2.0, 0.0], 0.65, [0.0, 0.4]), EventDriven())
    assert run.status == Status.DONE
    landing = run.impacts[run.impacts.kind == Kind.IMPACT]
    np.testing.assert_allclose(landing.time, [0.6], rtol=0, atol=1e-11)
    assert run.x[-1, 2] == pytest.approx(0.8 - 0.3 * 2.0 - 3.0 * 0.05, abs=1e-10)
