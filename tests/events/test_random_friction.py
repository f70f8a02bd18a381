"""Random scenes with friction; see `tests.random_friction`, which looks at any number of them."""

import numpy as np
import pytest

from lcpstep import EventDriven, Status, simulate
from tests.random_friction import answers, complaints, draw, nowhere_to_go

PER_TEST = 20


@pytest.mark.slow
@pytest.mark.parametrize("first", range(1000, 1200, PER_TEST))
@pytest.mark.parametrize("law", ["moreau", "stronge"])
def test_runs_end_create_no_energy_and_are_those_of_small_steps(first, law):
    for seed in range(first, first + PER_TEST):
        wrong, _ = complaints(seed, law)
        assert not wrong, f"scene {seed}: {wrong}"


@pytest.mark.parametrize("seed", [37, 482, 725])
def test_what_has_no_solution_is_said(seed):
    """Walls close on a body that friction holds between them, or belts pull it in; in 37 it meets them in turn."""
    scene = draw(seed)
    run = simulate(scene, EventDriven(1e-10, 1e-10, max_events=20000))
    assert run.status == Status.LCP_FAILED
    assert nowhere_to_go(scene, run.t[-1], run.q[-1], run.v[-1])


def test_all_answers_of_a_problem_are_found():
    W = np.array([[1.0, 0.4], [0.4, 1.0]])
    assert len(answers(W, np.array([-1.0, 0.1]), np.array([0.5]), [0.0])) == 1
    W = np.array([[1.0, -2.0], [-2.0, 5.0]])  # pressed by its own friction
    assert len(answers(W, np.array([0.1, 1.0]), np.array([0.8]), [-1.0])) == 2
