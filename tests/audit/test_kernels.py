"""What kernels certify is open: against dense looks at motions of all kinds, and compiled as uncompiled."""

import math
from dataclasses import replace

import numpy as np
import pytest

from benchmarks.audit.cases import bell, blind
from lagrangian import Harmonic, LinearContacts, LinearSystem, Scene, scenes
from lcpstep import EventDriven, Located, simulate
from lcpstep.audit import audit, first
from lcpstep.audit.cells import Cells
from lcpstep.audit.certify import Tally, divided, examine
from lcpstep.audit.curves import Curve, clear_curves
from lcpstep.audit.obstacle import Table
from lcpstep.audit.pieces import Pieces
from lcpstep.audit.polynomials import basis, through
from lcpstep.kernels.function import Function
from tests.marks import slow
from tests.turns.test_burrs import oscillator
from tests.uncompiled import both_ways

NOTHING = np.zeros(0)


def sinus(t, q, v, p, out):
    """A table that goes up and down: p = (amplitude, rate)."""
    s, c = p[0] * math.sin(p[1] * t), p[0] * math.cos(p[1] * t)
    out[0, 0], out[0, 1], out[0, 2] = s, p[1] * c, -p[1] * p[1] * s


def shaken(rng, forced=True):
    """A random damped oscillator or free body, under a force or none, above a table that may move."""
    w, free = rng.uniform(1.0, 10.0), rng.random() < 0.3
    rate = 2.0 * math.pi * rng.uniform(0.2, 2.0)
    moves = rng.random() < 0.5
    force = Harmonic(
        constant=-rng.uniform(1.0, 5.0) if free else rng.uniform(-1.0, 1.0),
        cosine=forced * rng.uniform(-3.0, 3.0), sine=forced * rng.uniform(-3.0, 3.0), omega=forced * rate,
    )  # fmt: skip
    system = LinearSystem(
        M=1.0,
        C=0.0 if free else rng.choice([0.0, rng.uniform(0.0, 0.3)]),
        K=0.0 if free else w * w,
        force=force,
    )
    contacts = LinearContacts(
        G=1.0,
        offset=rng.uniform(0.3, 1.0),
        restitution=rng.uniform(0.3, 1.0),
        motion=sinus if moves else None,
    )
    return Scene(
        system=system, contacts=contacts, q0=rng.uniform(0.1, 1.0), v0=rng.uniform(-1.0, 1.0), t_span=(0.0, 12.0),
        p=[rng.uniform(0.01, 0.2), rate], period=2.0 * math.pi / rate,
    )  # fmt: skip


def least(run, k):
    """The smallest gap inside of piece k, by dense looks."""
    t = np.linspace(run.t[k], run.t[k + 1], 60)[1:-1]
    q, v = run.at(t)
    return min(run.scene.gap(x, q[i], v[i])[0][0] for i, x in enumerate(t))


@pytest.mark.parametrize("method", [EventDriven(), Located(2e-2, order=4), Located(5e-3)])
def test_certified_pieces_are_open_and_are_most_of_them(method):
    rng = np.random.default_rng(3)
    for _ in range(6):
        run = simulate(shaken(rng), method)
        p = Pieces(run)
        found = first.look(p)[:, 0]
        flying = ~p.closed[:, 0] & (np.diff(p.t) > 1e-9)
        assert np.mean(found[flying]) > 0.9
        for k in rng.choice(np.flatnonzero(found & flying), 12):
            assert least(run, k) > -1e-9


def test_flights_on_springs_and_above_cams_that_are_certified_are_open():
    """Bounds of motion under springs alone, and of gaps that part from their events above corners."""
    rng = np.random.default_rng(7)
    made = [shaken(rng, forced=False) for _ in range(8)]
    made += [scenes.cam_follower(rpm=x, t_end=6.0) for x in rng.uniform(100.0, 900.0, 6)]
    shares = []
    for scene in made:
        run = simulate(scene, EventDriven())
        p = Pieces(run)
        found = first.look(p)[:, 0]
        flying = ~p.closed[:, 0] & (np.diff(p.t) > 1e-9)
        shares.append(np.mean(found[flying]))
        for k in rng.choice(np.flatnonzero(found & flying), 12):
            assert least(run, k) > -1e-9
    assert np.mean(shares) > 0.95


@pytest.mark.parametrize("width", [1e-2, 1e-4])
def test_a_piece_that_went_through_a_burr_is_not_certified(width):
    rng = np.random.default_rng(5)
    through_it = 0
    for _ in range(8):
        at = rng.uniform(1.0, 9.0)
        scene = oscillator(bell, [2.5, width, at], rng.uniform(0.0, 6.0))
        with blind():
            run = simulate(scene, EventDriven())
        if len(run.impacts) == 0:
            k = int(np.searchsorted(run.t, at)) - 1
            assert not first.look(Pieces(run))[k, 0]
            through_it += 1
    assert through_it > 0


def curve_of(x, touched=(0, 0)):
    """What kernels say of a contact whose gap has these coefficients in Bernstein's basis on [0, 1]."""
    none = Function(0, NOTHING, 1, 1, (1, 3))
    gap = Curve(Cells(None, 1, math.inf), none, none, [0.0], np.zeros((2, 1)), (1e-9, 1e-9, 0.0), len(x) - 1)
    found = np.zeros((1, 1), dtype=np.uint8)
    clear_curves(
        gap, np.array([0.0, 1.0]), np.ascontiguousarray(x)[None, :, None], np.ones((1, 1)), np.zeros(1),
        np.zeros((2, 1, 3)), np.zeros((1, 1)), 0.0, np.zeros((0, 1)), np.array(touched, dtype=np.uint8)[:, None],
        np.zeros((1, 1), dtype=np.uint8), NOTHING, found,
    )  # fmt: skip
    return bool(found[0, 0])


@pytest.mark.parametrize("degree", [2, 4, 7])
def test_polynomials_are_certified_where_they_are_positive(degree):
    rng = np.random.default_rng(degree)
    looks = basis(np.linspace(0.0, 1.0, 4001), degree)
    told = open_ = 0
    for _ in range(2000):
        x = rng.normal(size=degree + 1) + rng.uniform(0.0, 2.0)
        lowest, clear = np.min(looks @ x), curve_of(x)
        open_ += lowest > 1e-3
        told += clear
        assert not clear or lowest > 0.0
    assert told >= open_ > 100


def test_gaps_that_begin_and_end_with_events():
    rng = np.random.default_rng(1)
    looks = basis(np.linspace(0.0, 1.0, 4001)[1:-1], 4)
    for _ in range(2000):
        x = np.concatenate([[0.0], rng.normal(size=3) + 1.0, [0.0]])
        if curve_of(x, (1, 1)):
            assert np.min(looks @ x) > 0.0
    assert curve_of([0.0, 1.0, 0.0], (1, 1))
    assert not curve_of([0.0, -1.0, 0.0], (1, 1))
    assert not curve_of([0.0, 1.0, -3.0, 1.0, 0.0], (1, 1))


def test_polynomials_go_through_states():
    rng = np.random.default_rng(2)
    t, q, v = np.array([0.0, 0.5, 1.5]), rng.normal(size=(3, 2)), rng.normal(size=(3, 2))
    inner = rng.normal(size=(2, 3, 2))
    B = through(t, q, v, inner).B
    for k in range(2):
        np.testing.assert_allclose(basis(np.array([0.25, 0.5, 0.75]), 5) @ B[k], inner[k], rtol=0, atol=1e-12)
        np.testing.assert_allclose(B[k, [0, -1]], q[k : k + 2], rtol=0, atol=1e-12)
        np.testing.assert_allclose(5.0 * (B[k, 1] - B[k, 0]) / (t[k + 1] - t[k]), v[k], rtol=0, atol=1e-12)


PROGRAM = """
from hashlib import sha256
from lagrangian import scenes
from lcpstep import EventDriven, Located, simulate
from lcpstep.audit import first
from lcpstep.audit.pieces import Pieces
for scene, method in (
    (scenes.cam_follower(rpm=137.0, t_end=0.9), EventDriven()),
    (scenes.sticking_oscillator(t_end=30.0), EventDriven()),
    (scenes.elastic_gas(t_end=1.0), EventDriven()),
    (scenes.impact_oscillator(t_end=5.0), Located(1e-2, order=4)),
    (scenes.double_pendulum(t_end=1.0), EventDriven()),
    (scenes.cam_follower(t_end=1.0), Located(1e-3)),
    (scenes.chattering_table(t_end=2.0), Located(1e-3)),
    (scenes.chattering_table(t_end=20.0), EventDriven()),
):
    found = first.look(Pieces(simulate(scene, method)))
    print(found.shape, found.sum(), sha256(found.tobytes()).hexdigest())
"""


@pytest.mark.slow
def test_kernels_say_the_same_uncompiled():
    built, plain = both_ways(PROGRAM)
    assert built == plain


def test_kernels_know_what_steps_have_added_up_and_events_of_other_pieces():
    p = Pieces(simulate(scenes.cam_follower(t_end=20.0), Located(1e-3)))
    assert p.problem.drift.max() > 1e-3  # more than many gaps beside events
    assert np.all(first.look(p)[~p.closed])


def test_a_gap_within_its_error_is_not_halved_for_ever():
    p = Pieces(simulate(scenes.pendulum_stop(t_end=200.0), EventDriven()))
    left = ~first.look(p) & ~p.closed
    seen, looked = p.problem.seen, []

    def counted(w, *, rough):
        looked.append(len(w.a))
        return seen(w, rough=rough)

    p.problem.seen, p.problem.anchors, tally = counted, None, Tally()
    examine(p, divided(p, *np.nonzero(left)), tally)
    assert sum(looked) < 100 * np.sum(left)
    assert tally.windows
    assert not tally.found


def test_late_releases_are_not_taken_for_events_that_were_missed():
    """Of a table that moves fast, late: its phase is rounded, by more than a gap that has just opened."""
    answer = audit(simulate(scenes.chattering_table(t_end=300.0), EventDriven()))
    assert not answer.missed
    assert answer.certified == answer.flights


def test_the_audit_of_a_run_by_steps_and_by_events_agree():
    scene = scenes.cam_follower(t_end=1.0)
    for method in (EventDriven(), Located(1e-3), Located(1e-3, order="exact")):
        answer = audit(simulate(scene, method))
        assert answer.certified == answer.flights
        assert answer.share == pytest.approx(1.0, abs=1e-6)


def saw(t, q, v, p, out):
    """A table that goes up and down at one speed: p = (amplitude, rate)."""
    turn = p[1] * t / (2.0 * math.pi)
    turn -= math.floor(turn)
    up = turn < 0.5
    out[0, 0] = 2.0 * p[0] * (turn if up else 1.0 - turn)
    out[0, 1] = p[0] * p[1] / math.pi * (1.0 if up else -1.0)
    out[0, 2] = 0.0


@pytest.mark.parametrize("declared", slow([True, False], True))
@pytest.mark.parametrize("method", [EventDriven(), Located(1e-3)], ids=["event-driven", "order 2"])
def test_pieces_above_a_table_with_true_corners_are_certified_only_where_they_are_open(declared, method):
    for seed in range(4):
        scene = shaken(np.random.default_rng(seed))
        half = math.pi / scene.p[1]
        scene = replace(
            scene, contacts=replace(scene.contacts, motion=saw), t_span=(0.0, 4.0), period=2.0 * half,
            corners=[0.0, half] if declared else [],
        )  # fmt: skip
        with blind():
            run = simulate(scene, method)
        p = Pieces(run)
        flying = ~p.closed[:, 0] & (np.diff(p.t) > 1e-9)
        clear = first.look(p)[:, 0] & flying
        assert np.sum(clear) > 0.5 * np.sum(flying)
        for k in np.flatnonzero(clear)[:: max(1, int(np.sum(clear)) // 40)]:
            assert least(run, k) > -1e-12


def test_a_window_as_long_as_the_whole_table_meets_all_its_cells():
    """Their number may be a power of two."""
    ends = np.linspace(0.0, 1.0, 65)
    lo = np.zeros((64, 1, 3))
    lo[40, 0, 0] = -1.0
    hi = lo + 1.0
    hi[20, 0, 0] = 7.0
    table = Table(ends, lo, hi, np.zeros(64, dtype=bool), np.zeros(65, dtype=bool))
    bounds, _ = table.bounds(np.array([0]), np.array([0.0]), np.array([1.0]))
    assert (bounds.place.lo[0], bounds.place.hi[0]) == (-1.0, 7.0)
