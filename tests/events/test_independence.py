"""Events of one linear degree of freedom do not depend on what should not matter: span, rows, clock, units, sign."""

import math
from dataclasses import dataclass, replace

import numpy as np
import pytest

from lagrangian import Harmonic, LinearContacts, LinearSystem, Scene, scenes
from lagrangian.profiles import rotating_cam
from lcpstep import EventDriven, simulate
from lcpstep.trajectory import Kind, Status


def scaled_cam(t, q, v, p, out):
    rotating_cam(t, q, v, p[1:], out)
    for k in range(3):
        out[0, k] *= p[0]


def sine(t, q, v, p, out):
    out[0, 0] = p[0] * math.sin(p[1] * t)
    out[0, 1] = p[0] * p[1] * math.cos(p[1] * t)
    out[0, 2] = -p[0] * p[1] ** 2 * math.sin(p[1] * t)


@dataclass(frozen=True)
class View:
    """How a scene is looked at: its coordinate and its gap in other units, and so many periods later."""

    unit: float = 1.0
    gap: float = 1.0
    later: int = 0


def follower(view, rpm, restitution, coordinates):
    made, unit = scenes.cam_follower(rpm=rpm), view.unit * view.gap
    relative = coordinates == "relative"
    start = view.later * made.period
    return Scene(
        system=LinearSystem(
            1.221 / unit**2, K=1430.8 / unit**2, force=0.0, frame=scaled_cam if relative else None
        ),
        contacts=LinearContacts(
            view.gap / unit, restitution=restitution, motion=None if relative else scaled_cam
        ),
        q0=0.0 if relative else 0.1 * unit, v0=0.0, t_span=(start, start + 2.3 * made.period),
        p=[unit if relative else view.gap, *made.p], corners=made.corners, period=made.period,
    )  # fmt: skip


def oscillator(view, w, stop, restitution):
    unit, period = view.unit * view.gap, 2.0 * math.pi / w
    return Scene(
        system=LinearSystem(
            1.0 / unit**2, 0.1 / unit**2, 1.0 / unit**2, Harmonic(cosine=1.5 / unit, omega=w)
        ),
        contacts=LinearContacts(view.gap / unit, offset=-stop * view.gap, restitution=restitution),
        q0=0.9 * unit, v0=0.0, t_span=(view.later * period, (view.later + 3.3) * period), period=period,
    )  # fmt: skip


def table(view, w, restitution):
    unit, period = view.unit * view.gap, 2.0 * math.pi / w
    return Scene(
        system=LinearSystem(1.0 / unit**2, force=-9.81 / unit),
        contacts=LinearContacts(view.gap / unit, restitution=restitution, motion=sine),
        q0=0.03 * unit, v0=0.0, t_span=(view.later * period, (view.later + 6.3) * period),
        p=[0.01 * view.gap, w], period=period,
    )  # fmt: skip


SCENES = [
    pytest.param(lambda view: follower(view, 119.73, 0.8, "relative"), id="cam 119.73"),
    pytest.param(lambda view: follower(view, 131.0, 0.3, "absolute"), id="cam 131"),
    pytest.param(lambda view: follower(view, 118.2, 0.6, "absolute"), id="cam 118.2"),
    pytest.param(lambda view: oscillator(view, 0.3, 0.5, 0.6), id="oscillator 0.3"),
    pytest.param(lambda view: oscillator(view, 1.3, 0.26, 0.3), id="oscillator 1.3"),
    pytest.param(lambda view: table(view, 43.0, 0.3), id="table 43"),
    pytest.param(lambda view: table(view, 35.0, 0.5), id="table 35"),
]
every_scene = pytest.mark.parametrize("make", SCENES)


def log(scene, keep=1, atol=1e-12):
    run = simulate(scene, EventDriven(atol=atol), keep=keep)
    assert run.status is Status.DONE
    return run.impacts


def assert_same(events, others, later=0.0, gap=1.0, within=1e-11):
    np.testing.assert_array_equal([Kind(k) for k in events.kind], [Kind(k) for k in others.kind])
    np.testing.assert_allclose(others.time - later, events.time, rtol=0, atol=within)
    np.testing.assert_allclose(others.before / gap, events.before, rtol=1e-6, atol=1e5 * within)


@every_scene
def test_there_is_something_to_see(make):
    kinds = set(log(make(View())).kind)
    assert {Kind.IMPACT, Kind.ACCUMULATION, Kind.STICK} <= kinds


@every_scene
def test_another_end_of_the_span(make):
    whole = make(View())
    for share in (0.37, 0.81):
        end = whole.t_span[0] + share * (whole.t_span[1] - whole.t_span[0])
        events, short = log(whole), log(replace(whole, t_span=(whole.t_span[0], end)))
        early = end - 1e-4 * whole.period  # chattering that goes on at the end is not carried beyond it
        assert_same(events[events.time < early], short[short.time < early])


@every_scene
def test_other_rows_kept(make):
    scene = make(View())
    for keep in (7, "impacts", np.linspace(*scene.t_span, 11)):
        assert_same(log(scene), log(scene, keep), within=0.0)


@every_scene
@pytest.mark.parametrize("share", [0.313, 0.627])
def test_a_span_cut_in_two(make, share):
    whole = make(View())
    cut = whole.t_span[0] + share * (whole.t_span[1] - whole.t_span[0])
    first = simulate(replace(whole, t_span=(whole.t_span[0], cut)), EventDriven())
    rest = log(replace(whole, q0=first.q[-1], v0=first.v[-1], t_span=(cut, whole.t_span[1])))
    events = log(whole)
    again = rest.kind[0] == Kind.STICK and rest.time[0] == cut  # the contact is closed there
    assert_same(events[events.time >= cut], rest[1:] if again else rest, within=1e-9)


@every_scene
@pytest.mark.parametrize("later", [1, 10**4])
def test_whole_periods_later(make, later):
    scene = make(View())
    within = 1e-10 * math.sqrt(later)  # of the time, a rounding is 1e-12 s in the end
    assert_same(log(scene), log(make(View(later=later))), later=later * scene.period, within=within)


@every_scene
@pytest.mark.parametrize("unit", [-1.0, 1e-3, 1e3, -30.0])
def test_another_coordinate(make, unit):
    assert_same(log(make(View())), log(make(View(unit=unit))))


@every_scene
@pytest.mark.parametrize("gap", [1e-3, 1e3])
def test_another_unit_of_length(make, gap):
    assert_same(log(make(View())), log(make(View(gap=gap)), atol=1e-12 * gap), gap=gap)
