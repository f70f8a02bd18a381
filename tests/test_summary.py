"""What is shown of a run and of what is told about it, where a name stands alone in a notebook or at a prompt."""

import numpy as np
import pytest

from lagrangian import scenes
from lcpstep import EventDriven, Located, Moreau, energy, simulate, study
from lcpstep.summary import HEIGHT, sparkline


def test_a_sparkline_keeps_every_peak():
    t, x = np.linspace(0.0, 1.0, 100_000), np.zeros(100_000)
    x[54_321] = 1.0
    assert "130.4,2.0" in sparkline(t, x, np.zeros(0))
    assert f"M120.0 {HEIGHT}" in sparkline(t, x, np.array([0.5]))
    assert sparkline(t[:1], x[:1], np.zeros(0)) == ""


def test_what_holds_many_numbers_is_shown_in_a_line():
    """Arrays of thousands of numbers were printed instead."""
    ball = scenes.bouncing_ball(t_end=0.5)
    run = simulate(ball, Located(1e-3), error=True)
    assert repr(run.error) == f"ErrorBar({run.error})"
    assert repr(run.error.energy) == f"Bar({run.error.energy.sup:.2g} J)"
    assert repr(energy(simulate(ball, EventDriven()))).startswith("Energy(9.81 J -> ")
    found = study(ball, [Moreau(1e-2), Located(1e-2)], repeats=1)
    assert repr(found) == f"Study(bouncing-ball, {len(found.levels)} levels of Moreau, Located)"


def test_a_parameter_that_a_scene_does_not_have_is_answered_with_those_it_has():
    with pytest.raises(
        TypeError, match=r"^bouncing_ball\(\) has h0, v0, g, restitution, t_end, and no 'height'$"
    ):
        scenes.bouncing_ball(height=1.0)
