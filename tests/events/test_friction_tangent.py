"""Saltation matrices of contacts with friction, several contacts and joints, against differences of the flow."""

import math
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import assume, example, given, settings
from hypothesis import strategies as st

from lagrangian import Coulomb, Joints, LinearContacts, Scene, System, scenes
from lcpstep import EventDriven, Kind, LcpStepError, Status, simulate
from lcpstep.analysis.variation import monodromy
from tests.events.rough import block, rod, rod_row, weight

METHOD = EventDriven(1e-12, 1e-12)


def moved(scene, x, span):
    """The end of the motion, and what has happened."""
    n = scene.n_q
    one = replace(scene, q0=x[:n], v0=x[n:], t_span=span, exact=None)
    run = simulate(one, METHOD, keep=[span[1]])
    return np.concatenate([run.q[-1], run.v[-1]]), list(
        zip(run.impacts.kind, run.impacts.contact, strict=True)
    )


def difference(scene, x, span, u, d):
    """Derivative of the flow along u, of fourth order; None where neighbours see other events."""
    ends = [moved(scene, x + k * d * u, span) for k in (1.0, -1.0, 2.0, -2.0)]
    if any(events != ends[0][1] for _, events in ends):
        return None
    (one, _), (other, _), (far, _), (opposite, _) = ends
    return (8.0 * (one - other) - far + opposite) / (12.0 * d)


def compare(scene, x, span, directions, d=1e-4, within=1e-7):
    """Monodromy times each direction against differences."""
    x = np.asarray(x, dtype=float)
    J = monodromy(scene, METHOD, x, span)
    for u in np.asarray(directions, dtype=float):
        found = difference(scene, x, span, u, d)
        assert found is not None
        assert np.max(np.abs(found - J @ u)) < within * max(1.0, np.max(np.abs(found)))
    return J


ALONG = [[1.0, 0.0, 0.0, 0.0], [0.0, 0.0, 1.0, 0.0]]


def test_reversals_of_the_coulomb_oscillator():
    compare(scenes.coulomb_oscillator(), [1.05, 0.0, 0.03, 0.0], (0.0, 6.0), ALONG)


def test_what_stops_has_only_dead_beat_multipliers_but_that_of_its_place():
    J = compare(scenes.coulomb_oscillator(), [1.05, 0.0, 0.03, 0.0], (0.0, 18.0), ALONG)
    moduli = np.sort(np.abs(np.linalg.eigvals(J)))
    assert np.max(moduli[:3]) < 1e-14
    # each half cycle keeps the distance from its centre, so a deviation of the start is one of the end
    r = math.hypot(1.15, 0.03)  # it starts to the right, where friction pulls to the left
    assert moduli[3] == pytest.approx(1.15 / r, abs=1e-9)


@pytest.mark.parametrize("t_end", [4.0, 8.0, 12.0])
def test_a_belt_that_sways_takes_the_mass_along_and_lets_it_go(t_end):
    scene = scenes.mass_on_belt(amplitude=0.5, omega=0.9, mu=0.3)
    compare(scene, [0.2, 0.0, 0.1, 0.0], (0.0, t_end), ALONG)


@pytest.mark.parametrize("decay", [0.0, 0.3])
@pytest.mark.parametrize("t_end", [1.0, 7.5, 12.0])
def test_the_force_jumps_where_static_friction_gives_way(decay, t_end):
    """From a start that slips, on an even belt: the next slips are all at one place."""
    scene = scenes.stick_slip_belt(decay=decay)
    J = compare(scene, [1.3, 0.0, -0.4, 0.0], (0.0, t_end), ALONG, within=1e-5 if decay else 1e-9)
    # where the next slip is does not depend on the start, but when: a deviation is one along the motion
    assert np.linalg.matrix_rank(J, 1e-9) == (2 if t_end < 2.0 else 1)


@pytest.mark.parametrize("mu", [1.0, 0.1])
def test_bounces_of_a_superball_that_sticks_or_slides_through_them(mu):
    spin = 3.0 if mu == 1.0 else 30.0
    compare(scenes.superball(mu=mu), [0.0, 0.5, 0.0, 1.0, 0.0, spin], (0.0, 2.0), np.eye(6))


def test_a_plastic_landing_and_a_slope():
    compare(scenes.slope_landing(), [0.0, 0.2, 3.0, 0.0], (0.0, 0.6), np.eye(4))


@pytest.mark.parametrize("t_end", [0.01, 0.06, 0.14])
def test_the_woodpecker_through_impacts_sticking_slip_and_release(t_end):
    start = [0.0, 0.0, -0.2, -0.3, 1.0, -6.0]
    J = compare(scenes.woodpecker(), start, (0.0, t_end), np.eye(6), d=1e-5, within=1e-5)
    assert np.linalg.matrix_rank(J, 1e-9) == (4 if t_end < 0.05 else 3)


@pytest.mark.slow
@settings(max_examples=12, deadline=None)
@given(st.integers(0, 10**6), st.booleans())
@example(
    221638, True
)  # among the last of endless impacts one throws the other contact in at the same instant
def test_random_blocks_and_discs(seed, rough):
    scene = block(seed)
    if not rough:
        scene = replace(scene, contacts=replace(scene.contacts, friction=None))
    x = np.concatenate([scene.q0, scene.v0]) + np.array([0.0, 0.1, 0.0, 0.0, 0.0, 0.3])
    scene = replace(scene, q0=x[:3], v0=x[3:], t_span=(0.0, 0.7))
    assume(simulate(scene, METHOD).status == Status.DONE)
    together = None
    try:
        J = monodromy(scene, METHOD, x, (0.0, 0.7))
    except LcpStepError as error:
        together = str(error)
    if together is not None:
        assert "together" in together or "follow one another" in together
        return
    u = np.random.default_rng(seed).normal(size=6)
    found = [difference(scene, x, (0.0, 0.7), u / np.max(np.abs(u)), d) for d in (1e-5, 1e-6)]
    assume(found[0] is not None and found[1] is not None)
    size = max(1.0, float(np.max(np.abs(found[0]))))
    assume(np.max(np.abs(found[0] - found[1])) < 1e-4 * size)  # as far as differences can tell
    assert np.max(np.abs(found[1] - J @ u / np.max(np.abs(u)))) < 1e-3 * size


def test_a_wheel_that_comes_to_rest_between_wall_and_floor_by_endless_impacts_has_no_derivative():
    scene = block(61045)
    x = np.concatenate([scene.q0, scene.v0]) + np.array([0.0, 0.1, 0.0, 0.0, 0.0, 0.3])
    with pytest.raises(LcpStepError, match=r"contacts \[0, 1\] come to rest together"):
        monodromy(scene, METHOD, x, (0.0, 0.7))


def test_a_pendulum_on_a_rod_that_drags_along_a_wall_moves_as_its_angle():
    """In the angle th: ends of two runs whose starts are turned by +-d."""

    def scene(th, spin=0.0):
        return Scene(
            system=System(2, np.eye(2), weight), joints=Joints(1, rod, rod_row),
            contacts=LinearContacts([[1.0, 0.0]], restitution=0.4, friction=Coulomb(0.3, [[0.0, 1.0]])),
            q0=[math.sin(th), -math.cos(th)], v0=[spin * math.cos(th), spin * math.sin(th)], t_span=(0.0, 1.5),
        )  # fmt: skip

    def end(th):
        run = simulate(scene(th), METHOD, keep=[1.5])
        return np.concatenate([run.q[-1], run.v[-1]])

    made, d = scene(1.0), 1e-4
    J = monodromy(made, METHOD, np.concatenate([made.q0, made.v0]), (0.0, 1.5))
    found = (8.0 * (end(1.0 + d) - end(1.0 - d)) - end(1.0 + 2 * d) + end(1.0 - 2 * d)) / (12.0 * d)
    along = np.array([math.cos(1.0), math.sin(1.0), 0.0, 0.0])
    assert np.max(np.abs(found - J @ along)) < 1e-7
    across = np.array([math.sin(1.0), -math.cos(1.0), 0.0, 0.0])
    assert np.max(np.abs(J @ across)) < 1e-12  # the joint holds: nothing is left of a deviation from it


def test_a_pendulum_on_a_rod_without_contacts_moves_as_its_angle():
    rod_scene = replace(scenes.pendulum_stop(form="rod"), contacts=None, exact=None, t_span=(0.0, 2.0))
    angle = replace(scenes.pendulum_stop(), contacts=None, exact=None, t_span=(0.0, 2.0))
    J = monodromy(rod_scene, METHOD, rod_scene.x0, (0.0, 2.0))
    in_angle = monodromy(angle, METHOD, angle.x0, (0.0, 2.0))
    run = simulate(rod_scene, METHOD, keep=[2.0])
    (x, y), (x_t, y_t) = run.q[-1], run.v[-1]
    turn = np.array([[-y, 0.0], [x, 0.0], [-y_t, -y], [x_t, x]])  # d(q, v)/d(angle, rate) at the end
    start = rod_scene.x0
    along = np.array([-start[1], start[0], -start[3], start[2]])
    assert np.max(np.abs(J @ along - turn @ in_angle[:, 0])) < 1e-7


def test_impacts_at_one_time_are_refused_by_the_names_of_their_contacts():
    scene = Scene(
        system=scenes.sliding_rocking_block().system,
        contacts=LinearContacts(
            [[0, 1, 0.3], [0, 1, -0.3]], restitution=0.5, friction=Coulomb(0.3, [[1, 0, 0.4]] * 2)
        ),
        q0=[0.0, 0.2, 0.0], v0=[0.5, 0.0, 0.0], t_span=(0.0, 0.3),
    )  # fmt: skip
    with pytest.raises(LcpStepError, match=r"contacts \[0, 1\] strike together"):
        monodromy(scene, METHOD, [0.0, 0.2, 0.0, 0.5, 0.0, 0.0], (0.0, 0.3))


def test_a_corner_of_the_belt_is_no_event_of_the_state():
    """A belt that starts to run at t = 1 drags a block at rest: its end does not depend on when it slipped."""
    scene = Scene(
        system=scenes.sliding_block().system,
        contacts=LinearContacts([[0.0, 1.0]], friction=Coulomb(0.3, tangent, slip=starts)),
        q0=[0.0, 0.0], v0=[0.0, 0.0], t_span=(0.0, 1.3), corners=[1.0],
    )  # fmt: skip
    run = simulate(scene, METHOD)
    assert Kind.SLIP in run.impacts.kind
    J = monodromy(scene, METHOD, np.zeros(4), (0.0, 1.3))
    expected = np.zeros((4, 4))
    expected[0, 0] = 1.0
    assert np.max(np.abs(J - expected)) < 1e-9


def tangent(t, q, v, p, out):
    out[0, 0], out[0, 1] = 1.0, 0.0


def starts(t, q, v, p, out):
    out[0] = 0.0 if t < 1.0 else -2.0
