"""Random scenes with friction; see `tests.random_friction`, which looks at any number of them."""

from dataclasses import replace

import numpy as np
import pytest

from lcpstep import EventDriven, Kind, Moreau, Status, simulate
from tests.marks import shared
from tests.random_friction import answers, close_impacts, complaints, draw, left_open, nowhere_to_go

PER_TEST = 20


@pytest.mark.parametrize("first", shared(range(1000, 1200, PER_TEST), 10))
@pytest.mark.parametrize("law", ["moreau", "stronge"])
def test_runs_end_create_no_energy_and_are_those_of_small_steps(first, law):
    for seed in range(first, first + PER_TEST):
        wrong, _ = complaints(seed, law)
        assert not wrong, f"scene {seed}: {wrong}"


@pytest.mark.parametrize("seed", [5000060, 6000335, 6001137, 7001019])
def test_sliding_slower_than_the_tolerance_does_not_feed_a_chattering(seed):
    wrong, end = complaints(seed)
    assert not wrong
    assert end == "DONE"


@pytest.mark.parametrize("seed", [2311362, 2312078, 5000449, 6000132, 6001004, 6000468])
def test_the_end_of_a_chattering_creates_no_energy(seed):
    """Walls and belts move; in 6000468 the other contact slides fast, and is not stopped with the one that hopped."""
    wrong, _ = complaints(seed)
    assert not wrong


def in_another_unit(scene, unit):
    """The same scene with gaps in another unit; forces of the normals are in another one, too."""
    c = scene.contacts
    friction = replace(c.friction, mu=unit * c.friction.mu)
    return replace(scene, contacts=replace(c, G=unit * c.G, offset=unit * c.offset, friction=friction))


@pytest.mark.parametrize("seed", [106, 1])
def test_hops_end_in_whatever_unit_gaps_are_told(seed):
    tolerance = 1e-10
    method = EventDriven(tolerance, tolerance)
    runs = [simulate(in_another_unit(draw(seed), unit), method) for unit in (1.0, 1e3, 1e-3)]
    for run in runs[1:]:
        assert run.status == Status.DONE
        np.testing.assert_array_equal(run.impacts.kind, runs[0].impacts.kind)
        np.testing.assert_allclose(run.impacts.time, runs[0].impacts.time, rtol=0, atol=tolerance)
        np.testing.assert_allclose(run.q[-1], runs[0].q[-1], rtol=0, atol=tolerance)


def test_two_sliding_contacts_with_several_answers_are_named():
    """A block on belts that run against each other may stay, or tip over either foot."""
    scene = draw(5000929)
    c = scene.contacts
    D = np.vstack([c.G, c.friction.tangent])
    M, force = scene.system.M, scene.system.force
    slip = c.friction.tangent @ scene.v0 + c.friction.slip
    b = D @ np.linalg.solve(M, np.array(force.constant) + np.array(force.cosine) - scene.system.C @ scene.v0)
    assert len(answers(D @ np.linalg.solve(M, D.T), b, c.friction.mu, np.sign(slip))) == 3
    run = simulate(scene, EventDriven())
    assert run.status == Status.PAINLEVE_INDETERMINATE
    assert "beside what else is held" in run.message


def test_a_body_wedged_between_two_walls_is_let_go_as_the_force_along_the_smooth_one_turns():
    """Three forces hold two coordinates: the friction of the rough wall alone is beyond its cone all the time."""
    scene = draw(7000502)
    smooth, force = scene.contacts.friction.tangent[0], scene.system.force
    first = np.arccos(-smooth @ np.array(force.constant) / (smooth @ np.array(force.cosine))) / force.omega
    run = simulate(scene, EventDriven())
    let_go = run.impacts.time[(run.impacts.kind == Kind.RELEASE) & (run.impacts.time > 0.6)]
    expected = first + 2.0 * np.pi / force.omega * np.array([1, 2])
    np.testing.assert_allclose(let_go, expected, atol=1e-10)
    assert complaints(7000502) == ([], "DONE")


def test_impacts_closer_than_small_steps_are_judged_by_smaller_ones():
    """One contact hops by 1e-7 as the other is struck; then they strike in turn, eight times within a microsecond."""
    scene = draw(7002395)
    run = simulate(scene, EventDriven(1e-10, 1e-10))
    (window,) = close_impacts(run, 0.36)
    assert window[2] < 1e-8
    assert complaints(7002395) == ([], "DONE")


def test_a_start_with_several_answers_is_left_open():
    scene = draw(5000929)
    assert left_open(scene, simulate(scene, Moreau(1e-4)), 0.0)
    scene = draw(7000502)
    assert not left_open(scene, simulate(scene, Moreau(1e-4)), 0.0)


@pytest.mark.parametrize(
    ("seed", "status"),
    [(37, Status.LCP_FAILED), (482, Status.LCP_FAILED), (725, Status.PAINLEVE_INCONSISTENT)],
)
def test_what_has_no_solution_is_said(seed, status):
    """Walls close on a body that friction holds between them, or belts pull it in; in 37 it meets them in turn."""
    scene = draw(seed)
    run = simulate(scene, EventDriven(1e-10, 1e-10, max_events=20000))
    assert run.status == status
    assert nowhere_to_go(scene, run.t[-1], run.q[-1], run.v[-1])


def test_all_answers_of_a_problem_are_found():
    W = np.array([[1.0, 0.4], [0.4, 1.0]])
    assert len(answers(W, np.array([-1.0, 0.1]), np.array([0.5]), [0.0])) == 1
    W = np.array([[1.0, -2.0], [-2.0, 5.0]])  # pressed by its own friction
    assert len(answers(W, np.array([0.1, 1.0]), np.array([0.8]), [-1.0])) == 2


@pytest.mark.parametrize(
    ("law", "seed"), [("moreau", 4), ("moreau", 6), ("moreau", 40), ("stronge", 16), ("stronge", 106)]
)
@pytest.mark.parametrize("keep", ["impacts", 50, "ends"])
def test_what_is_kept_changes_no_digit_of_a_motion(law, seed, keep):
    scene = draw(seed, law)
    whole = simulate(scene, EventDriven())
    other = simulate(scene, EventDriven(), keep=list(scene.t_span) if keep == "ends" else keep)
    for name in ("time", "contact", "before", "after", "impulse", "kind"):
        np.testing.assert_array_equal(other.impacts[name], whole.impacts[name])
    np.testing.assert_array_equal(other.q[-1], whole.q[-1])
    np.testing.assert_array_equal(other.v[-1], whole.v[-1])
