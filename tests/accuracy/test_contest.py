"""Methods side by side: errors against exact motions, levels that fall, refusals with their reasons."""

import numpy as np
import pytest

from lagrangian import LinearContacts, LinearSystem, Scene, scenes
from lcpstep import EventDriven, LcpStepError, Located, Moreau
from lcpstep.accuracy.contest import contest
from lcpstep.plot.contest import contests

METHODS = [Moreau(2e-3), Located(2e-3), Located(2e-3, order=4), EventDriven()]
EXACT = Located(2e-3, order="exact")  # refuses friction


def test_errors_are_those_of_the_exact_motion_and_fall_with_the_step():
    scene = scenes.impact_oscillator(t_end=10.0)
    found = contest(scene, METHODS)
    assert found.reference == "the motion in closed form"
    for entrant in found.entrants:
        run = entrant.run
        assert entrant.error == np.max(np.abs(run.q - scene.exact(run.t)[0]))
        assert len(run.t) == len(found.t)
    moreau, second, fourth, exact = found.entrants
    assert moreau.error > second.error > fourth.error > exact.error
    for entrant, order in ((second, 2), (fourth, 4)):
        steps, errors = np.array([(x.value, x.error) for x in entrant.levels]).T
        assert np.polyfit(np.log(steps), np.log(errors), 1)[0] == pytest.approx(order, abs=0.6)
    assert [x.value for x in exact.levels] == [1e-4, 1e-6, 1e-8, 1e-10, 1e-12]


def test_without_a_closed_form_the_reference_is_a_tighter_run():
    found = contest(scenes.double_pendulum(t_end=1.0), METHODS)
    assert found.reference == "event-driven at a tolerance of 1e-13"
    assert found.entrants[-1].error < 1e-9 < found.entrants[1].error
    assert found.unit == "rad"


def test_what_is_refused_says_why_and_what_nothing_treats_is_an_error():
    found = contest(scenes.coulomb_oscillator(t_end=3.0), [*METHODS, EXACT])
    assert [bool(x.reason) for x in found.entrants] == [False, False, False, False, True]
    assert "friction" in found.entrants[-1].reason
    with pytest.raises(ValueError, match="methods: expected at least one method"):
        contest(scenes.coulomb_oscillator(), [])
    with pytest.raises(LcpStepError, match="no method treats 'coulomb-oscillator'"):
        contest(scenes.coulomb_oscillator(t_end=3.0), [EXACT])


def test_steps_that_are_too_long_for_the_motion_are_left_out():
    stiff = Scene(
        LinearSystem(1.0, K=1e6), q0=1.0, v0=0.0, t_span=(0.0, 0.05), contacts=LinearContacts(1.0, 2.0)
    )
    found = contest(stiff, [Moreau(1e-4, theta=0.0), EventDriven()])
    assert all(np.isfinite(x.error) for entrant in found.entrants for x in entrant.levels)


def test_a_picture_of_scenes_with_refusals():
    found = [
        contest(scene, [*METHODS, EXACT])
        for scene in (scenes.coulomb_oscillator(t_end=1.0), scenes.bouncing_ball(t_end=1.0))
    ]
    figure = contests(found, ["one", "two"])
    assert [len(ax.get_lines()) > 1 for ax in figure.axes] == [True, True, True, True, True, True]
    (legend,) = figure.legends
    assert {x.get_text() for x in legend.get_texts()} == {
        "reference", "Moreau", "Located, order 2", "Located, order 4", "EventDriven", "Located, order exact",
    }  # fmt: skip
