"""Every run ends: at rest, at the start, at a corner, without gravity, without a contact, at its bound of events."""

import math

import numpy as np
import pytest

from lagrangian import Harmonic, LinearContacts, LinearSystem, Scene, System, scenes
from lcpstep import EventDriven, Located, Moreau, SimulationInterrupted, simulate
from lcpstep.recording import Recorder
from lcpstep.trajectory import Kind, Status
from tests.models import ball_on_table, no_damping


def weight(t, q, v, p, out):
    out[0] = -p[0]


SYSTEMS = {
    "closed form": lambda g: {"system": LinearSystem(M=1.0, force=-g)},
    "Runge-Kutta": lambda g: {"system": System(1, 1.0, weight, no_damping, no_damping), "p": [g]},
}
every_flow = pytest.mark.parametrize("flow", SYSTEMS)


def ball(flow, restitution, q0, v0, g=8.0, t_end=2.0):
    return Scene(
        **SYSTEMS[flow](g), contacts=LinearContacts(G=1.0, restitution=restitution), q0=q0, v0=v0,
        t_span=(0.0, t_end), name="ball",
    )  # fmt: skip


def kinds(m):
    return [Kind(e.kind).name for e in m.impacts]


@every_flow
@pytest.mark.parametrize("r", [0.0, 0.3, 1.0])
def test_a_ball_at_rest_on_the_floor_stays_there(flow, r):
    m = simulate(ball(flow, r, 0.0, 0.0), EventDriven())
    assert kinds(m) == ["STICK"]
    assert np.all(m.q == 0.0)
    assert np.all(m.v == 0.0)
    assert m.impulse.sum() == pytest.approx(16.0, rel=1e-13)
    assert m.status is Status.DONE


@every_flow
def test_hops_below_the_tolerance_from_the_floor_at_the_start_take_no_negative_impulse(flow):
    m = simulate(ball(flow, 0.5, 0.0, 1e-3), EventDriven(1e-6, 1e-6))
    assert "ACCUMULATION" in kinds(m)
    assert np.all(m.impulse >= 0.0)
    assert m.impulse.sum() == pytest.approx(16.0 - 1e-3, rel=1e-13)


@every_flow
def test_a_weightless_ball_at_rest_on_the_floor_stays_there(flow):
    m = simulate(ball(flow, 0.5, 0.0, 0.0, g=0.0), EventDriven())
    assert m.status is Status.DONE
    assert np.all(m.q == 0.0)
    assert m.impulse.sum() == 0.0


@every_flow
@pytest.mark.parametrize("r", [0.0, 0.5, 1.0])
def test_an_impact_at_the_very_start_is_an_impact(flow, r):
    m = simulate(ball(flow, r, 0.0, -4.0, t_end=0.9), EventDriven())
    e = m.impacts[0]
    assert (e.time, e.kind, e.before, e.after, e.impulse) == (0.0, Kind.IMPACT, -4.0, 4.0 * r, 4.0 * (1 + r))
    assert m.v[0, 0] == 4.0 * r  # the right limit
    assert m.status is Status.DONE
    if r == 1.0:
        assert m.at(0.5)[0][0] == pytest.approx(1.0, abs=1e-13)


@every_flow
def test_a_start_on_the_floor_upwards_flies(flow):
    m = simulate(ball(flow, 0.5, 0.0, 4.0, t_end=0.9), EventDriven())
    assert len(m.impacts) == 0
    assert m.q[-1, 0] == pytest.approx(4.0 * 0.9 - 4.0 * 0.81, rel=1e-13)


@every_flow
def test_a_start_on_the_floor_pulled_upwards_flies(flow):
    m = simulate(ball(flow, 0.5, 0.0, 0.0, g=-8.0, t_end=1.0), EventDriven())
    assert "STICK" not in kinds(m)
    assert m.q[-1, 0] == pytest.approx(4.0, rel=1e-13)


@every_flow
def test_a_plastic_impact_is_followed_by_rest(flow):
    m = simulate(ball(flow, 0.0, 1.0, 0.0), EventDriven())
    assert kinds(m) == ["IMPACT", "STICK"]
    assert m.impacts.time == pytest.approx(0.5, rel=1e-13)
    assert m.impacts[0].impulse == pytest.approx(4.0, rel=1e-12)
    assert m.at(1.7)[0][0] == 0.0


@every_flow
def test_a_weightless_ball_leaves_after_its_impact(flow):
    m = simulate(ball(flow, 0.5, 1.0, -2.0, g=0.0, t_end=3.0), EventDriven())
    assert kinds(m) == ["IMPACT"]
    assert m.q[-1, 0] == pytest.approx(2.5, rel=1e-13)


@every_flow
def test_a_weightless_plastic_ball_stays_where_it_struck(flow):
    m = simulate(ball(flow, 0.0, 1.0, -2.0, g=0.0, t_end=3.0), EventDriven())
    assert m.status is Status.DONE
    assert abs(m.q[-1, 0]) < 1e-13
    assert m.v[-1, 0] == 0.0


@every_flow
@pytest.mark.parametrize("r", [0.8, 0.95, 0.99])
def test_infinitely_many_impacts_end(flow, r):
    t_acc = 0.5 * (1 + r) / (1 - r)
    m = simulate(ball(flow, r, 1.0, 0.0, t_end=1.1 * t_acc), EventDriven())
    assert kinds(m)[-2:] == ["ACCUMULATION", "STICK"]
    assert m.impacts.time[-1] == pytest.approx(t_acc, rel=1e-10)
    assert m.status is Status.DONE
    np.testing.assert_array_equal(m.q[m.t > m.impacts.time[-1]], 0.0)


@every_flow
def test_a_span_that_ends_within_the_accumulation_ends(flow):
    # 1e-9 s before the accumulation at 1.5 s
    m = simulate(ball(flow, 0.5, 1.0, 0.0, t_end=1.5 - 1e-9), EventDriven())
    assert m.status is Status.DONE
    assert m.t[-1] == 1.5 - 1e-9
    assert abs(m.q[-1, 0]) < 1e-12


@every_flow
@pytest.mark.parametrize("t_end", [0.5, 1.0, np.nextafter(0.5, 0.0), np.nextafter(0.5, 1.0)])
def test_a_span_that_ends_at_an_impact_ends(flow, t_end):
    m = simulate(ball(flow, 0.5, 1.0, 0.0, t_end=float(t_end)), EventDriven())
    assert m.status is Status.DONE
    assert m.t[-1] == t_end
    assert len(m.impacts) <= 2


@every_flow
@pytest.mark.parametrize("bound", [1, 7, 20])
def test_the_bound_of_events_ends_a_run_and_says_so(flow, bound):
    m = simulate(ball(flow, 1.0, 1.0, 0.0, t_end=100.0), EventDriven(max_events=bound))
    assert m.status is Status.TOO_MANY_EVENTS
    assert f"max_events = {bound}" in m.message
    assert bound <= len(m.impacts) <= bound + 1
    assert m.t[-1] == m.impacts.time[-1] < 100.0
    assert m.at(0.25)[0][0] == pytest.approx(0.75, abs=1e-12)


def test_a_scene_without_contacts_runs_to_its_end():
    system = LinearSystem(
        M=np.eye(2), K=[[2.0, -1.0], [-1.0, 2.0]], force=Harmonic(cosine=[1.0, 0.0], omega=2.5)
    )
    m = simulate(Scene(system, [1.0, 0.0], [0.0, 0.0], (0.0, 5.0)), EventDriven())
    assert m.status is Status.DONE
    assert m.impulse.shape == (len(m.t), 0)
    # modes (1, 1) and (1, -1) of frequencies 1 and sqrt(3), each forced by 1/2
    t, modes = m.t, []
    for w2 in (1.0, 3.0):
        X = 0.5 / (w2 - 6.25)
        modes.append(X * np.cos(2.5 * t) + (0.5 - X) * np.cos(math.sqrt(w2) * t))
    np.testing.assert_allclose(m.q[:, 0], modes[0] + modes[1], rtol=0, atol=1e-11)


@pytest.mark.parametrize(
    ("name", "bad"),
    [("rtol", 0.0), ("rtol", 1e-15), ("rtol", 2.0), ("rtol", math.nan), ("atol", 0.0), ("atol", -1.0),
     ("atol", math.nan), ("max_events", 0), ("max_events", math.nan), ("rtol", "tight")],
)  # fmt: skip
def test_tolerances_out_of_range_are_refused_by_name(name, bad):
    with pytest.raises(ValueError, match=rf"^{name}: "):
        EventDriven(**{name: bad})


# --- an obstacle that falls away


def kinked(t, q, v, p, out):
    """At rest until t = 1, then falling with the acceleration -p[0]."""
    tau = max(t - 1.0, 0.0)
    out[0, 0], out[0, 1], out[0, 2] = -0.5 * p[0] * tau**2, -p[0] * tau, -p[0] if t > 1.0 else 0.0


@every_flow
@pytest.mark.parametrize("faster", [True, False])
def test_a_ball_is_released_exactly_at_a_corner_if_the_floor_falls_faster(flow, faster):
    fall = 10.0 if faster else 6.0
    system = (
        SYSTEMS["closed form"](8.0)
        if flow == "closed form"
        else {"system": LinearSystem(M=1.0, force=pulled)}
    )
    scene = Scene(
        **{**system, "p": [fall]}, contacts=LinearContacts(G=1.0, restitution=0.5, motion=kinked), q0=0.0, v0=0.0,
        t_span=(0.0, 1.5), corners=[1.0],
    )  # fmt: skip
    m = simulate(scene, EventDriven())
    assert kinds(m) == (["STICK", "RELEASE"] if faster else ["STICK"])
    if faster:
        assert m.impacts.time[1] == 1.0
    drop = 0.5 * (8.0 if faster else 6.0)
    for tau in (1e-3, 0.1, 0.2, 0.499, 0.5):
        assert m.at(1.0 + tau)[0][0] == pytest.approx(-drop * tau**2, abs=1e-13)


def pulled(t, q, v, p, out):
    out[0] = -8.0


def test_a_follower_on_a_slow_table_never_leaves_it():
    m = simulate(ball_on_table(0.01, 31.0, 0.3, 0.0, 0.0, 1.0), EventDriven())  # A w^2 = 9.61 < g
    assert "RELEASE" not in kinds(m)
    assert m.status is Status.DONE


@pytest.mark.parametrize("method", [Moreau(1e-2), Located(1e-2), EventDriven()])
def test_ctrl_c_while_the_trajectory_is_put_together_leaves_it_whole(method, monkeypatch):
    scene = scenes.bouncing_ball(t_end=1.0)
    whole, events, calls = simulate(scene, method, keep="impacts"), Recorder.log, []

    def interrupted(recorder, end):
        calls.append(end)
        if len(calls) == 1:
            raise KeyboardInterrupt
        return events(recorder, end)

    monkeypatch.setattr(Recorder, "log", interrupted)
    with pytest.raises(SimulationInterrupted) as stopped:
        simulate(scene, method, keep="impacts")
    m = stopped.value.trajectory
    assert m.status == Status.INTERRUPTED
    np.testing.assert_array_equal(m.q, whole.q)
    np.testing.assert_array_equal(m.impacts.time, whole.impacts.time)
