"""Narrow burrs of obstacles whose motion is known are not flown through."""

import math
import warnings

import numpy as np
import pytest

from lagrangian import Contacts, LinearContacts, LinearSystem, Scene, System, scenes
from lcpstep import EventDriven, Located, simulate
from lcpstep.turns import FastTurn, turns
from tests.marks import slow

OFFSET, FAST = 1.05, 2.0 * math.pi
METHODS = [EventDriven(), Located(1e-2), Located(1e-2, order=4), Located(1e-2, tolerance=1e-6)]


def bump(t, q, v, p, out):
    """Height (1 - s^2)^3 at p = (height, half-width, place, period)."""
    x = t - p[3] * math.floor(t / p[3])
    s = (x - p[2]) / p[1]
    out[0, 0] = out[0, 1] = out[0, 2] = 0.0
    if abs(s) < 1.0:
        w = 1.0 - s * s
        out[0, 0] = p[0] * w**3
        out[0, 1] = -6.0 * p[0] * s * w * w / p[1]
        out[0, 2] = (24.0 * s * s * w - 6.0 * w * w) * p[0] / p[1] ** 2


def bell(t, q, v, p, out):
    """Height exp(-s^2): a burr without a branch."""
    s = (t - p[2]) / p[1]
    e = p[0] * math.exp(-s * s)
    out[0, 0], out[0, 1], out[0, 2] = e, -2.0 * s * e / p[1], (4.0 * s * s - 2.0) * e / p[1] ** 2


def roof(t, q, v, p, out):
    """A triangle, whose corners the scene does not name."""
    s = (t - p[2]) / p[1]
    out[0, 0] = out[0, 1] = out[0, 2] = 0.0
    if abs(s) < 1.0:
        out[0, 0], out[0, 1] = p[0] * (1.0 - abs(s)), -math.copysign(p[0] / p[1], s)


def table(t, q, v, p, out):
    """Points of a table, 2000 in ten seconds, with straight lines between them; p: the heights."""
    x = 200.0 * t
    k = min(int(x), 1999)
    out[0, 0], out[0, 1], out[0, 2] = p[k] + (x - k) * (p[k + 1] - p[k]), 200.0 * (p[k + 1] - p[k]), 0.0


def oscillator(motion, p, phase, period=math.inf):
    """One oscillation a second, of amplitude 1, above what moves."""
    return Scene(
        system=LinearSystem(M=1.0, K=FAST**2),
        contacts=LinearContacts(G=1.0, offset=OFFSET, restitution=0.8, motion=motion),
        q0=math.cos(phase), v0=-FAST * math.sin(phase), t_span=(0.0, 10.0), p=p, period=period,
    )  # fmt: skip


def strikes(motion, p, phase):
    """Whether the free motion meets the burr, by 2001 looks at it, as (meets, clear)."""
    out, least = np.zeros((1, 3)), math.inf
    for t in p[2] + 3.0 * p[1] * np.linspace(-1.0, 1.0, 2001):
        motion(t, None, None, p, out)
        least = min(least, math.cos(FAST * t + phase) + OFFSET - out[0, 0])
    return least < -1e-3, least > 1e-3


@pytest.mark.parametrize("motion", [bump, bell, roof])
@pytest.mark.parametrize("width", slow([1e-1, 1e-2, 1e-3, 1e-4], longest=[1e-1, 1e-2, 1e-4]))
def test_no_burr_is_flown_through(motion, width):
    rng = np.random.default_rng(int(1e4 * width))
    for k in range(6):
        phase, place = rng.uniform(0.0, FAST), rng.uniform(0.5, 9.5)
        p = [rng.uniform(0.05, 1.0), width, place, 10.0]
        meets, clear = strikes(motion, p, phase)
        scene = oscillator(motion, p, phase)
        struck = len(simulate(scene, METHODS[k % len(METHODS)]).impacts) > 0
        assert struck or not meets
        assert not struck or not clear


@pytest.mark.parametrize("width", [1e-2, 1e-3])
def test_a_burr_in_every_period_is_met_by_all_methods_alike(width):
    scene = oscillator(bump, [0.5, width, 0.43, 1.0], 0.0, period=1.0)
    runs = [simulate(scene, m) for m in (EventDriven(), Located(1e-3, order=4))]
    first = [m.impacts.time[0] for m in runs]
    assert first[0] == pytest.approx(first[1], abs=1e-9)
    assert 0.43 - width < first[0] < 0.43 + width


def test_what_turns_slowly_or_everywhere_gets_no_stops():
    assert len(turns(scenes.cam_follower()).stops) == len(scenes.cam_follower().corners)

    def sine(t, q, v, p, out):
        x = p[0] * t
        out[0, 0], out[0, 1], out[0, 2] = math.sin(x), p[0] * math.cos(x), -p[0] * p[0] * math.sin(x)

    for omega in (1.0, 6.0, 3000.0):
        found = turns(oscillator(sine, [omega], 0.0))
        assert len(found.stops) == 0


def test_stops_lie_where_it_turns_and_only_there():
    found = turns(oscillator(bump, [0.1, 1e-3, 4.0, 10.0], 0.0))
    assert 10 < len(found.stops) < 80
    assert np.all(np.abs(found.stops - 4.0) < 1.1e-3)


def test_points_of_a_table_are_looked_at():
    heights = np.zeros(2001)
    heights[[777, 1500]] = 0.5, 0.3
    scene = oscillator(table, heights, 0.0)
    out, met = np.zeros((1, 3)), []
    for k in (777, 1500):
        t = k / 200.0
        table(t, None, None, heights, out)
        met.append(math.cos(FAST * t) + OFFSET < out[0, 0])
    assert met == [False, True]
    m = simulate(scene, EventDriven())
    assert abs(m.impacts.time[0] - 7.5) < 5e-3


def test_where_samples_alone_tell_a_warning_names_what_turns():
    def unknown(t, q, v, p, out):
        bell(t, q, v, p, out)
        out[0, 0] += 0.0 * math.gamma(2.0 + t)

    with pytest.warns(FastTurn, match=r"contacts.motion turns within .* s.*unknown .*corners"):
        turns(oscillator(unknown, [0.1, 0.05, 4.0], 0.0))
    for method in (EventDriven(), Located(1e-2)):
        with pytest.warns(FastTurn) as heard:
            simulate(oscillator(unknown, [0.1, 0.06, 4.0], 0.0), method, keep="impacts")
        assert heard[0].filename == __file__  # the line that calls, however deep inside the warning is
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        turns(oscillator(unknown, [0.0, 1.0, 4.0], 0.0))


def gap(t, q, v, p, out):
    """The burr as a gap of any form."""
    s = (t - p[2]) / p[1]
    out[0] = q[0] + OFFSET - p[0] * math.exp(-s * s)


def gap_t(t, q, v, p, out):
    """Its rate."""
    s = (t - p[2]) / p[1]
    out[0] = 2.0 * s * p[0] * math.exp(-s * s) / p[1]


def up(t, q, v, p, out):
    """Its Jacobian."""
    out[0, 0] = 1.0


def spring(t, q, v, p, out):
    """A linear force as a function."""
    out[0] = -FAST * FAST * q[0]


@pytest.mark.parametrize("method", METHODS[:3])
def test_gaps_of_any_form_as_well(method):
    scene = Scene(
        system=System(1, [[1.0]], spring), contacts=Contacts(1, gap, up, gap_t, restitution=0.8),
        q0=1.0, v0=0.0, t_span=(0.0, 10.0), p=[0.5, 1e-3, 4.47],
    )  # fmt: skip
    m = simulate(scene, method)
    assert abs(m.impacts.time[0] - 4.47) < 3e-3


def test_the_tails_of_a_burr_do_not_make_the_whole_scan_fine():
    """One of the samples that show how fast everything turns lies five widths from the burr."""
    scene = oscillator(bell, [0.495797345, 1.79999318e-05, 3.87452818], 0.3)
    assert simulate(scene, EventDriven()).counts.steps < 1000
    assert not turns(scene).elsewhere(np.array([3.87452818 - 1e-4]), math.inf)[0]
    assert turns(scene).elsewhere(np.array([0.0, 3.8, 3.9, 10.0]), math.inf).all()


PLACE = 3.3333
SETTINGS = {"place": PLACE}


def bell_at_place(t, q, v, p, out):
    s = (t - PLACE) / 1e-3
    e = 0.1 * math.exp(-s * s)
    out[0, 0], out[0, 1], out[0, 2] = e, -2e3 * s * e, (4.0 * s * s - 2.0) * e * 1e6


def bell_in_settings(t, q, v, p, out):
    s = (t - SETTINGS["place"]) / 1e-3
    e = 0.1 * math.exp(-s * s)
    out[0, 0], out[0, 1], out[0, 2] = e, -2e3 * s * e, (4.0 * s * s - 2.0) * e * 1e6


@pytest.mark.filterwarnings("ignore::lcpstep.model.UncompiledCallback", "ignore::lcpstep.turns.FastTurn")
@pytest.mark.parametrize("motion", [bell_at_place, bell_in_settings])
def test_a_burr_is_looked_for_where_the_values_that_its_function_reads_have_brought_it(motion, monkeypatch):
    scene = Scene(LinearSystem(M=1.0), 0.05, 0.0, (0.0, 10.0), LinearContacts(G=1.0, motion=motion))
    for place in (PLACE, 6.6667):
        monkeypatch.setitem(globals(), "PLACE", place)
        monkeypatch.setitem(SETTINGS, "place", place)
        times = simulate(scene, Located(0.1)).impacts.time
        assert times[0] == pytest.approx(place - 1e-3 * math.sqrt(math.log(2.0)), abs=1e-5)
