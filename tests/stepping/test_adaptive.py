"""Steps chosen by a tolerance: errors follow it, steps concentrate where the motion needs them."""

import dataclasses

import numpy as np
import pytest

from lagrangian import Harmonic, LinearContacts, LinearSystem, Scene, scenes
from lcpstep import EventDriven, Kind, Located, Moreau, Status, simulate
from lcpstep.stepping.by_tolerance.sizes import LOOK
from tests.known import ball_height

TOLERANCES = (1e-3, 1e-4, 1e-5, 1e-6)


def oscillator():
    return dataclasses.replace(scenes.impact_oscillator(), t_span=(0.0, 10.0))


def test_errors_follow_the_tolerance_through_impacts():
    at = np.linspace(0.0, 10.0, 57)
    true = simulate(oscillator(), EventDriven(), keep=at)
    errors = []
    for tolerance in TOLERANCES:
        m = simulate(oscillator(), Located(0.5, tolerance=tolerance), keep=at)
        errors.append(np.max(np.abs(m.q - true.q)))
        assert np.array_equal(m.t, at)
        assert np.array_equal(m.impacts.contact, true.impacts.contact)
        assert errors[-1] <= tolerance * (1.0 + np.max(np.abs(true.q)))
    assert 0.8 < np.polyfit(np.log(TOLERANCES), np.log(errors), 1)[0] < 1.2


@pytest.mark.slow
def test_fewer_steps_of_order_four_for_small_tolerances():
    at = np.linspace(0.0, 10.0, 57)
    true = simulate(oscillator(), EventDriven(), keep=at)
    tolerances, errors, steps = (1e-5, 1e-6, 1e-7, 1e-8, 1e-9), [], []
    for tolerance in tolerances:
        m = simulate(oscillator(), Located(0.5, order=4, tolerance=tolerance), keep=at)
        errors.append(np.max(np.abs(m.q - true.q)))
        steps.append(m.counts.steps)
        assert errors[-1] <= tolerance * (1.0 + np.max(np.abs(true.q)))
    assert 0.7 < np.polyfit(np.log(tolerances), np.log(errors), 1)[0] < 1.3
    assert -0.35 < np.polyfit(np.log(tolerances), np.log(steps), 1)[0] < -0.15
    assert steps[1] < 0.1 * simulate(oscillator(), Located(0.5, tolerance=1e-6)).counts.steps


def test_the_log_of_a_chattering_ball_is_complete():
    scene = scenes.bouncing_ball(t_end=5.0)
    fixed, m = simulate(scene, Located(1e-3)), simulate(scene, Located(0.1, tolerance=1e-6))
    assert m.status == Status.DONE
    assert m.t[-1] == 5.0
    assert np.all(np.diff(m.t) > 0.0)
    assert m.counts.events == len(m.impacts)
    n = 20
    assert np.array_equal(m.impacts.kind[:n], fixed.impacts.kind[:n])
    assert np.allclose(m.impacts.time[:n], fixed.impacts.time[:n], rtol=0.0, atol=1e-9)
    m = simulate(scene, Located(0.1, tolerance=1e-6), keep=np.linspace(0.0, 5.0, 31))
    assert np.max(np.abs(m.q[:, 0] - ball_height(1.0, 9.81, 0.8)(m.t))) < 1e-6


def test_steps_are_short_where_the_motion_is_fast_and_kept_states_are_a_choice():
    m = simulate(oscillator(), Located(0.5, tolerance=1e-4))
    steps = np.diff(m.t)
    assert steps.max() <= 0.25
    assert steps.min() < 0.05 * steps.max()
    third = simulate(oscillator(), Located(0.5, tolerance=1e-4), keep=3)
    assert np.array_equal(third.q[:50], m.q[:150:3])
    assert np.array_equal(third.impacts, m.impacts)


def test_a_tolerance_that_cannot_be_met_ends_the_run():
    m = simulate(oscillator(), Located(0.5, tolerance=1e-17))
    assert m.status == Status.STEP_TOO_SMALL
    assert "tolerance" in m.message
    assert "t = " in m.message
    assert m.t[-1] < 10.0


def error(scene, method, n=1601):
    """Largest error of the position at even times, relative to 1 + its size."""
    at = np.linspace(*scene.t_span, n)
    true = scene.exact(at)[0]
    m = simulate(scene, method, keep=at)
    assert m.status == Status.DONE
    return np.max(np.abs(m.q - true)) / (1.0 + np.max(np.abs(true)))


@pytest.mark.parametrize("h", [0.628, 2.0, 60.0])
@pytest.mark.parametrize(("order", "tolerances"), [(2, (1e-3, 1e-5)), (4, (1e-5, 1e-8))])
def test_errors_after_releases_are_seen(h, order, tolerances):
    """What both halves share after an event, and a contact that both let go at one wrong time."""
    scene = dataclasses.replace(scenes.sticking_oscillator(), t_span=(0.0, 60.0))
    for tolerance in tolerances:
        assert error(scene, Located(h, order=order, tolerance=tolerance)) <= tolerance


@pytest.mark.parametrize("h", [0.02, 0.1, 0.5])
@pytest.mark.parametrize("tolerance", [1e-3, 1e-6])
def test_a_table_throws_its_ball_off_in_time(h, tolerance):
    """Motion in flight has no error, so steps get as long as the table's period: all errors are the contact's."""
    assert error(scenes.chattering_table(), Located(h, tolerance=tolerance)) <= tolerance


@pytest.mark.parametrize("order", [2, 4])
@pytest.mark.parametrize("periods", [4.0, 16.0])
def test_a_force_that_lifts_what_rests_is_not_stepped_over(order, periods):
    """Steps and halves of whole periods sample the force -1 - 2 cos(t) only where it presses."""
    system = LinearSystem(M=1.0, force=Harmonic(constant=-1.0, cosine=-2.0, omega=1.0))
    scene = Scene(system, [0.0], [0.0], (0.0, 32.0 * np.pi), LinearContacts(1.0, restitution=0.0))
    at = np.linspace(*scene.t_span, 1601)
    true = simulate(scene, EventDriven(), keep=at).q
    m = simulate(scene, Located(periods * 2.0 * np.pi, order=order, tolerance=1e-4), keep=at)
    assert np.max(true) > 0.1
    assert np.max(np.abs(m.q - true)) <= 1e-3


def test_a_contact_stays_closed_over_more_steps_than_a_buffer_holds():
    """A mass that slides on a floor, x'' = -9 x, for thousands of steps."""
    system = LinearSystem(np.eye(2), K=np.diag([9.0, 0.0]), force=Harmonic([0.0, -9.81]))
    contacts = LinearContacts([[0.0, 1.0]], [0.0], 0.5)
    scene = Scene(system, contacts=contacts, q0=[1.0, 0.0], v0=[0.0, 0.0], t_span=(0.0, 20.0))
    m = simulate(scene, Located(0.5, tolerance=1e-5))
    assert m.status == Status.DONE
    assert m.counts.steps > LOOK
    assert np.max(np.abs(m.q[:, 0] - np.cos(3.0 * m.t))) < 2e-5
    assert np.allclose(m.impulse[:, 0].sum(), 9.81 * 20.0, rtol=1e-9)


@pytest.mark.parametrize("start", [0.0, 7140.0])
@pytest.mark.parametrize("order", [2, 4])
def test_what_is_lifted_off_does_not_land_by_rounding(start, order):
    """The gap a t^2 / 2 is finer at first than the coordinate is told; the motion is known."""
    contacts = LinearContacts([[-1.0]], [2.24], 1.0)
    system = LinearSystem([[1.0]], K=[[0.3]], force=Harmonic([-0.347]))
    scene = Scene(system, contacts=contacts, q0=[2.24], v0=[0.0], t_span=(start, start + 0.06))
    m = simulate(scene, Located(0.5, order=order, tolerance=1e-6))
    assert m.status == Status.DONE
    assert m.impacts.kind.tolist() in ([], [Kind.RELEASE])
    assert m.counts.steps < 100
    w, mean = np.sqrt(0.3), -0.347 / 0.3
    exact = mean + (2.24 - mean) * np.cos(w * (m.t - start))
    assert np.max(np.abs(m.q[:, 0] - exact)) < 1e-6
    assert np.all(np.diff(m.t) > 0.0)
    assert m.t[-1] == start + 0.06


@pytest.mark.parametrize(
    "method", [Located(0.1, tolerance=1e-5), Located(0.1, 4, tolerance=1e-7), Moreau(0.1, tolerance=1e-2)]
)
@pytest.mark.parametrize("start", [0.3, 5420.0, -17699.3, 83800.0])
def test_times_go_on_and_end_as_asked_far_from_zero(method, start):
    """Events, kept states and the steps between them agree about one instant to the bit."""
    system = LinearSystem(
        np.eye(2), K=[[12.0, -3.0], [-3.0, 5.0]], force=Harmonic([-2.0, -1.0], [1.0, 0.7], [0.0, 0.3], 7.0)
    )
    contacts = LinearContacts([[1.0, 0.0], [0.3, 1.0]], [0.1, 0.05], [0.5, 0.0])
    for length in (0.010918, 1.0 / 3.0, 1.9):
        scene = Scene(
            system, contacts=contacts, q0=[0.1, 0.2], v0=[-1.0, 0.3], t_span=(start, start + length)
        )
        m = simulate(scene, method)
        assert m.status == Status.DONE
        assert m.t[-1] == start + length
        assert np.all(np.diff(m.t) >= 0.0)
        assert np.all(np.diff(m.impacts.time) >= 0.0)
        assert np.all(m.impacts.time <= m.t[-1])
        at = np.linspace(start, start + length, 7)
        assert np.array_equal(simulate(scene, method, keep=at).t, at)


def swinging(t, q, v, p, out):
    out[0] = 0.03 * np.sin(1.3 * t), 0.039 * np.cos(1.3 * t), -0.0507 * np.sin(1.3 * t)


def test_what_rests_on_a_moving_table_stays_on_it_between_steps():
    """It is carried without error, so that steps are long; between them it is where the table is."""
    contacts = LinearContacts([[1.0]], [0.0], 0.5, motion=swinging)
    scene = Scene(
        LinearSystem([[1.0]], force=Harmonic([-9.81])),
        contacts=contacts,
        q0=[0.0],
        v0=[0.039],
        t_span=(0.0, 6.0),
    )
    m = simulate(scene, Located(0.8, tolerance=1e-6))
    t = np.linspace(0.0, 6.0, 333)
    assert np.max(np.diff(m.t)) > 0.2
    assert np.max(np.abs(m.at(t)[0][:, 0] - 0.03 * np.sin(1.3 * t))) < 1e-9


@pytest.mark.parametrize("tolerance", [1e-2, 1e-3, 1e-4])
def test_many_impacts_in_a_step_have_one_share_of_the_tolerance_together(tolerance):
    """A body that a spring presses to and fro against a wall, some two thousand elastic hops, beside a free one."""
    system = LinearSystem(np.eye(2), K=84.0 * np.array([[1.0, -1.0], [-1.0, 1.0]]))
    contacts = LinearContacts([[-1.0, 0.0]], [0.1], 1.0)
    scene = Scene(system, [0.1, 1.5], [-0.0018, 0.0], t_span=(0.0, 0.07), contacts=contacts)
    at = np.linspace(0.0, 0.07, 30)
    m, true = (
        simulate(scene, Located(0.07, tolerance=tolerance), keep=at),
        simulate(scene, EventDriven(), keep=at),
    )
    assert len(true.impacts) > 2000
    assert np.max(np.abs(m.q - true.q)) <= 0.3 * tolerance


@pytest.mark.parametrize(("h", "t_end"), [(0.24, 0.69), (0.24, 0.71), (0.24, 0.77), (0.1, 0.64)])
def test_two_walls_met_at_once_along_a_groove_are_struck_together(h, t_end):
    """A body slides to and fro in a pyramid whose four faces meet in one point, where its step may end anyhow."""
    rows = [[0.272, 0.0948, 0.958], [-0.253, 0.725, 0.64], [-0.437, -0.152, 0.886], [0.318, -0.914, 0.252]]
    force = Harmonic([0.0, 0.0, -7.35], [0.779, 3.2, 2.94], [1.45, 0.534, -0.432], omega=1.98)
    system = LinearSystem(np.diag([0.532, 0.937, 0.749]), force=force)
    contacts = LinearContacts(rows, restitution=0.042)
    scene = Scene(system, [0.0, 0.0, 0.0], [0.0, 0.0, 0.0], t_span=(0.0, t_end), contacts=contacts)
    at = np.linspace(0.0, t_end, 60)
    m, true = simulate(scene, Located(h, 4, tolerance=1e-8), keep=at), simulate(scene, EventDriven(), keep=at)
    assert np.max(np.abs(m.q - true.q)) <= 1e-9


def test_bad_input_is_named():
    for bad in (0.0, -1.0, np.nan):
        with pytest.raises(ValueError, match="tolerance"):
            Located(0.1, tolerance=bad)
    with pytest.raises(ValueError, match="exact"):
        Located(0.1, order="exact", tolerance=1e-6)


def driven(periods):
    """An oscillator before a stop, so many periods of its force from time zero."""
    start = periods * 2.0 * np.pi / 20.0
    system = LinearSystem([[1.0]], K=[[40.0]], force=Harmonic(constant=-9.81, sine=30.0, omega=20.0))
    contacts = LinearContacts([[1.0]], restitution=0.5)
    return Scene(system=system, contacts=contacts, q0=0.3, v0=0.0, t_span=(start, start + 0.5))


def test_steps_do_not_shrink_to_what_times_far_from_zero_are_rounded_by():
    """Four days from zero forces are rounded by 1e-9 of themselves: no shorter step shows less."""
    near, far = (simulate(driven(n), Located(0.05, 4, tolerance=1e-9)) for n in (0, 10**6))
    true = simulate(driven(10**6), EventDriven())
    at = np.linspace(*far.scene.t_span, 300)
    assert far.counts.steps < 2 * near.counts.steps
    assert np.max(np.abs(far.at(at)[0] - true.at(at)[0])) < 2e-9
