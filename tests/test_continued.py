"""A run that goes on from the end of another is the run over the whole span."""

import warnings
from dataclasses import replace

import numpy as np
import pytest
from scipy import sparse

from lagrangian import LinearContacts, LinearSystem, Scene, scenes
from lagrangian.scenes.hybrid_abs import hybrid_abs
from lagrangian.scenes.hybrid_oscillators import bilinear_oscillator, stick_slip_oscillator
from lcpstep import (
    EventDriven,
    LcpStepError,
    Located,
    Moreau,
    SimulationInterrupted,
    Status,
    continued,
    simulate,
)
from lcpstep.continuing import PutBack
from tests.models import bowl_scene
from tests.stepping.jointed import point_on_a_rod

EXACT = EventDriven(1e-11, 1e-11)
H = 2.0**-7


def cut(scene, method, share, then=None):
    """The whole run, and the second of two that part it at this share of its span."""
    start, end = scene.t_span
    first = simulate(replace(scene, t_span=(start, start + share * (end - start))), method)
    return simulate(scene, method), simulate(continued(first, t_end=end), then or method)


def apart(a, b):
    return max(np.max(np.abs(a.q[-1] - b.q[-1])), np.max(np.abs(a.v[-1] - b.v[-1])))


@pytest.fixture(autouse=True)
def nothing_put_back(request):
    """Nothing is moved by more than rounding, unless a test says so."""
    with warnings.catch_warnings():
        if "moved" not in request.keywords:
            warnings.simplefilter("error", PutBack)
        yield


SMOOTH = {
    "bouncing": (lambda: scenes.bouncing_ball(t_end=1.5), 1e-13),
    "chattering": (lambda: scenes.bouncing_ball(restitution=0.5, t_end=2.0), 1e-13),
    "a moving obstacle": (lambda: scenes.chattering_table(t_end=2.0), 1e-12),
    "a moving frame": (lambda: scenes.cam_follower(t_end=0.5), 1e-10),
    "sticking": (lambda: scenes.sticking_oscillator(t_end=6.0), 1e-12),
    "one curved contact": (lambda: bowl_scene([0.5, 0.0], [0.0, 0.0], 1.0), 1e-8),
    "several at rest": (lambda: scenes.stack(t_end=1.0), 1e-13),
    "several in turn": (lambda: scenes.inelastic_collapse(t_end=3.0), 1e-12),
}


@pytest.mark.parametrize("share", [0.25, 0.61, 0.97])
@pytest.mark.parametrize("name", SMOOTH)
def test_an_event_driven_run_goes_on_as_if_it_had_not_ended(name, share):
    make, tolerance = SMOOTH[name]
    whole, rest = cut(make(), EXACT, share)
    assert apart(whole, rest) < tolerance
    assert rest.t[0] == pytest.approx(share * whole.t[-1], rel=1e-15)


@pytest.mark.parametrize("share", [0.25, 0.625, 0.9375])
@pytest.mark.parametrize("name", [x for x in SMOOTH if x != "one curved contact"])
def test_a_located_run_cut_on_a_step_is_the_same_to_rounding(name, share):
    scene = SMOOTH[name][0]()
    whole, rest = cut(scene, Located(H * (scene.t_span[1] - scene.t_span[0])), share)
    assert apart(whole, rest) < 1e-11


def test_another_method_goes_on_where_one_has_ended():
    scene = scenes.impact_oscillator(t_end=8.0)
    whole, rest = cut(scene, EXACT, 0.4, then=Located(1e-3, order="exact"))
    assert apart(whole, rest) < 1e-9
    assert rest.scene.exact is None
    assert rest.scene.parameters == scene.parameters


def test_what_has_underflowed_at_rest_is_zero():
    """The lowest mass of a chain lies on the floor with 2e-323 m/s, in which no digit is left to go on with."""
    _, rest = cut(replace(scenes.elastic_chain(), t_span=(0.0, 1.5)), EventDriven(), 0.5)
    assert rest.scene.v0[0] == 0.0
    assert rest.status is Status.DONE


def test_a_ball_that_lies_stays_lying_and_nothing_happens():
    _, rest = cut(scenes.bouncing_ball(restitution=0.5, t_end=4.0), EXACT, 0.9)
    assert np.all(rest.q == 0.0)
    assert np.all(rest.v == 0.0)
    assert not np.any(rest.impacts.kind == 0)
    assert rest.impulse.sum() == pytest.approx(9.81 * 0.4, rel=1e-12)


# --- what a method leaves inside an obstacle or off a joint


@pytest.mark.moved
def test_positions_are_put_back_by_the_least_change_in_the_metric_of_the_mass():
    M, G = np.array([[2.0, 0.5], [0.5, 1.0]]), np.array([[0.6, 0.8]])
    system = LinearSystem(M, force=[0.0, -9.81])
    scene = Scene(system, [0.0, 0.3], [0.3, 0.0], (0.0, 0.7), LinearContacts(G, restitution=0.0))
    run = simulate(scene, Moreau(0.03))
    g = float((G @ run.q[-1])[0])
    assert g < -1e-3
    with pytest.warns(PutBack, match=rf"contact 0 by {-g:.3g} m"):
        went_on = continued(run, t_end=1.0)
    expected = run.q[-1] - np.linalg.solve(M, G[0]) * g / (G[0] @ np.linalg.solve(M, G[0]))
    np.testing.assert_allclose(went_on.q0, expected, rtol=0.0, atol=1e-15)
    assert np.all(np.abs(went_on.gap(0.7, went_on.q0, went_on.v0)) < 1e-15)


@pytest.mark.moved
def test_a_ball_in_a_bowl_is_put_back_onto_it():
    run = simulate(scenes.bowl(t_end=0.6), Moreau(0.02))
    assert np.hypot(*run.q[-1]) > 1.0 + 1e-3
    with pytest.warns(PutBack, match="contact 0"):
        went_on = continued(run, t_end=2.0)
    assert np.hypot(*went_on.q0) == pytest.approx(1.0, abs=1e-13)
    direction = run.q[-1] / np.hypot(*run.q[-1])
    np.testing.assert_allclose(went_on.q0, direction, rtol=0.0, atol=1e-13)  # the nearest point of a circle


@pytest.mark.moved
def test_no_contact_is_pulled_and_none_pushed_into_another():
    corner = LinearContacts([[1.0, 0.0], [0.6, 0.8], [-1.0, 0.0]], offset=[0.0, 0.0, 1e-3])
    scene = Scene(LinearSystem(np.eye(2), force=[-5.0, -9.81]), [5e-4, 0.2], [0.0, 0.0], (0.0, 1.0), corner)
    with pytest.warns(PutBack):
        went_on = continued(simulate(scene, Moreau(0.05)), t_end=2.0)
    g, _ = went_on.gap(1.0, went_on.q0, went_on.v0)
    assert np.all(g >= -1e-15)


@pytest.mark.moved
def test_a_point_is_put_back_onto_its_rod_and_swings_on():
    run = simulate(point_on_a_rod(2.0, 0.8), Moreau(0.01))
    off = abs(np.hypot(*run.q[-1]) - 1.0)
    assert off > 1e-5
    with pytest.warns(PutBack, match="joint 0"):
        went_on = continued(run, t_end=1.6)
    np.testing.assert_allclose(went_on.q0, run.q[-1] / np.hypot(*run.q[-1]), rtol=0.0, atol=1e-13)
    along = went_on.v0 @ went_on.q0
    assert abs(along) < 1e-15
    np.testing.assert_allclose(
        went_on.v0, run.v[-1] - (run.v[-1] @ went_on.q0) * went_on.q0, rtol=0.0, atol=1e-13
    )
    assert simulate(went_on, Moreau(0.01)).status.name == "DONE"


def test_joints_of_a_method_that_keeps_them_stay_where_they_are():
    whole, rest = cut(scenes.elastic_chain(t_end=0.4), EventDriven(1e-10, 1e-10), 0.5)
    assert apart(whole, rest) < 1e-7


def test_friction_sticks_and_slides_on():
    for scene in (scenes.coulomb_oscillator(t_end=4.0), scenes.sliding_block(t_end=1.0)):
        span = scene.t_span[1] - scene.t_span[0]
        whole, rest = cut(scene, Moreau(H * span), 0.625)
        assert apart(whole, rest) < 1e-12


@pytest.mark.usefixtures("sparse_steps")
@pytest.mark.moved
def test_sparse_scenes_go_on_without_a_dense_matrix():
    dense = scenes.falling_gas(n=30, t_end=2.0)
    G = sparse.csr_array(np.asarray(dense.contacts.G))
    scene = replace(
        dense, system=LinearSystem(sparse.eye_array(30, format="csr"), force=dense.system.force),
        contacts=LinearContacts(G, dense.contacts.offset, dense.contacts.restitution), exact=None,
    )  # fmt: skip
    run = simulate(scene, Moreau(0.02))
    assert run.penetration.max() > 1e-4
    with pytest.warns(PutBack, match="and .* more"):
        went_on = continued(run, t_end=3.0)
    assert hasattr(went_on.system.M, "toarray")
    assert np.min(went_on.gap(2.0, went_on.q0, went_on.v0)[0]) >= -1e-14
    with pytest.warns(PutBack):
        as_dense = continued(replace(run, scene=dense), t_end=3.0)
    np.testing.assert_allclose(went_on.q0, as_dense.q0, rtol=0.0, atol=1e-12)


# --- ends of other kinds


def test_an_interrupted_run_goes_on():
    scene, seen = scenes.bouncing_ball(t_end=3.0), []

    def impatient(t):
        seen.append(t)
        if t > 1.0:
            raise KeyboardInterrupt

    with pytest.raises(SimulationInterrupted) as stopped:
        simulate(scene, Located(2.0**-17), progress=impatient)
    first = stopped.value.trajectory
    assert 1.0 < first.t[-1] < 3.0
    rest = simulate(continued(first, t_end=3.0), Located(2.0**-10))
    assert abs(rest.q[-1, 0] - scene.exact(np.array([3.0]))[0][0, 0]) < 1e-9


def test_a_run_that_stopped_for_its_bound_goes_on():
    scene = scenes.cam_follower(t_end=1.0)
    first = simulate(scene, EventDriven(1e-11, 1e-11, max_events=5))
    assert first.status.name == "TOO_MANY_EVENTS"
    rest = simulate(continued(first, t_end=1.0), EXACT)
    assert apart(rest, simulate(scene, EXACT)) < 1e-9


@pytest.mark.parametrize("share", [0.3, 0.77])
@pytest.mark.parametrize(
    "make", [bilinear_oscillator, stick_slip_oscillator, lambda t_end: hybrid_abs(t_end=t_end)]
)
def test_a_motion_with_modes_goes_on_in_its_mode(make, share):
    scene = make(t_end=2.0)
    whole = simulate(scene, EXACT)
    first = simulate(replace(scene, t_span=(0.0, 2.0 * share)), EXACT, keep="impacts")
    went_on = continued(first, t_end=2.0)
    assert went_on.mode == whole.mode_at(2.0 * share)
    rest = simulate(went_on, EXACT)
    scale = np.max(np.abs(whole.x), axis=0)
    assert np.max(np.abs(rest.x[-1] - whole.x[-1]) / scale) < 1e-9
    assert rest.mode[-1] == whole.mode[-1]


def test_a_motion_with_modes_goes_on_from_a_switch():
    scene = bilinear_oscillator(t_end=6.0)
    whole = simulate(scene, EXACT)
    at = float(whole.switches.time[1])
    rest = simulate(continued(simulate(replace(scene, t_span=(0.0, at)), EXACT), t_end=6.0), EXACT)
    np.testing.assert_allclose(rest.x[-1], whole.x[-1], rtol=0.0, atol=1e-9)
    np.testing.assert_allclose(rest.switches.time, whole.switches.time[2:], rtol=0.0, atol=1e-9)


def test_what_cannot_go_on_is_refused():
    run = simulate(scenes.bouncing_ball(t_end=1.0), Moreau(1e-2))
    with pytest.raises(ValueError, match="t_end: expected a time after the end of the run, 1 s, got 1"):
        continued(run, t_end=1.0)
    nothing = replace(run, t=run.t[:0], q=run.q[:0], v=run.v[:0])
    with pytest.raises(ValueError, match="has kept a state"):
        continued(nothing, t_end=2.0)


def test_a_slit_that_is_too_narrow_leaves_no_position():
    slit = LinearContacts([[1.0], [-1.0]], offset=[0.0, 0.1])
    run = simulate(Scene(LinearSystem(1.0), 0.05, 0.0, (0.0, 1.0), slit), Moreau(0.1))
    narrow = replace(run, scene=run.scene, q=np.full_like(run.q, -0.05))
    object.__setattr__(run.scene.contacts, "offset", np.array([0.0, -0.1]))
    with pytest.raises(LcpStepError, match="no position near its end satisfies all joints and contacts"):
        continued(narrow, t_end=2.0)
