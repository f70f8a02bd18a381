"""Error measures on motions whose distance is known by hand."""

import itertools
import math
from dataclasses import dataclass
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from lagrangian import Harmonic, LinearSystem, Scene, scenes
from lcpstep import EventDriven, Located, Moreau, simulate
from lcpstep.accuracy import errors
from lcpstep.accuracy.errors import MEASURES, Difference
from lcpstep.accuracy.graphs import Graph, hausdorff
from lcpstep.accuracy.matching import match_impacts
from lcpstep.trajectory import IMPACT_DTYPE, Kind
from tests.marks import slow

BALL = scenes.bouncing_ball()
SPRING = Scene(
    system=LinearSystem(M=2.0, K=8.0, force=Harmonic(constant=3.0)), q0=0.0, v0=0.0, t_span=(0.0, 1.0)
)


def log_of(times, impulses=None, contacts=None, kind=Kind.IMPACT):
    log = np.zeros(len(times), dtype=IMPACT_DTYPE)
    log["time"], log["kind"] = times, kind
    log["impulse"] = 1.0 if impulses is None else impulses
    log["contact"] = 0 if contacts is None else contacts
    return log.view(np.recarray)


@dataclass
class Made:
    """A motion by its formulas."""

    q: Any
    v: Any
    times: Any = ()
    impulses: Any = None
    t: Any = (0.0, 1.0)
    scene: Any = BALL

    def __post_init__(self):
        self.t, self.impacts = np.asarray(self.t, dtype=float), log_of(self.times, self.impulses)

    def at(self, t):
        t = np.atleast_1d(t)
        return tuple(np.reshape(np.broadcast_to(f(t), t.shape), (-1, 1)) for f in (self.q, self.v))


def step_up(at, low=-3.0, high=2.0, **more):
    """Velocity that jumps at the given time."""
    return Made(
        lambda t: np.where(t < at, low * t, low * at + high * (t - at)), lambda t: np.where(t < at, low, high), [at],
        [high - low], **more,
    )  # fmt: skip


@pytest.mark.parametrize("late", [1e-1, 1e-3, 1e-7, 1e-11])
@pytest.mark.parametrize("grid", [(0.0, 1.0), tuple(np.linspace(0.0, 1.0, 778))])
def test_an_impact_that_comes_late(late, grid):
    d = Difference(step_up(0.4 + late), step_up(0.4, t=grid), within=0.2)
    late = (0.4 + late) - 0.4
    exact = pytest.approx
    assert d.sup_position == exact(5.0 * late, rel=1e-9, abs=1e-15)
    assert d.l1_velocity == exact(5.0 * late, rel=1e-9)
    # the jumps are as high and stand `late` apart; the pointwise sup of v would be 5 whatever the delay
    assert d.graph_distance == exact(late, rel=1e-5)
    assert Difference(step_up(0.4 + late), step_up(0.4), rate=7.0).graph_distance == exact(7 * late, rel=1e-5)
    assert (d.impact_time, d.impact_impulse, d.unmatched) == (exact(late, rel=1e-9), 0.0, 0)
    assert d.energy == exact(late * 0.5 * (9.0 - 4.0), rel=1e-6, abs=8 * 9.81 * late)


def test_an_impact_too_strong():
    d = Difference(step_up(0.4, high=2.5), step_up(0.4))
    assert d.sup_position == pytest.approx(0.5 * 0.6)
    assert d.l1_velocity == pytest.approx(0.5 * 0.6)
    assert d.graph_distance == pytest.approx(0.5, rel=1e-5)
    assert (d.impact_time, d.impact_impulse, d.unmatched) == (0.0, pytest.approx(0.5), 0)


def test_a_missing_pair_of_impacts_is_counted_and_costs_its_jump_however_short():
    brief = 1e-6
    spike = Made(
        lambda t: 0 * t, lambda t: np.where((t >= 0.4) & (t < 0.4 + brief), 3.0, 0.0), [0.4, 0.4 + brief]
    )
    d = Difference(spike, Made(lambda t: 0 * t, lambda t: 0 * t))
    assert d.graph_distance == pytest.approx(3.0, rel=1e-5)
    assert d.l1_velocity == pytest.approx(3.0 * brief, rel=1e-6)
    assert (d.unmatched, d.impacts.extra, d.impacts.missing) == (2, 2, 0)
    assert d.impact_time == math.inf


def test_energy_counts_mass_stiffness_and_constant_force():
    moving = Made(lambda t: 0.5 + 0 * t, lambda t: 2.0 + 0 * t, scene=SPRING)
    resting = Made(lambda t: 0 * t, lambda t: 0 * t, scene=SPRING)
    assert Difference(moving, resting).energy == pytest.approx(0.5 * 2 * 4 + 0.5 * 8 * 0.25 - 3 * 0.5)


def test_penetration_is_that_of_the_first_motion_between_its_grid_points_too():
    sunk = Made(lambda t: 1e-3 - 4 * 3e-3 * t * (1 - t), lambda t: 0 * t)
    above = Made(lambda t: 1.0 + 0 * t, lambda t: 0 * t)
    assert Difference(sunk, above).penetration == pytest.approx(2e-3, rel=1e-6)
    assert Difference(above, sunk).penetration == 0.0


def test_the_largest_coordinate_counts_and_times_are_those_in_common():
    plane = Scene(system=LinearSystem(M=np.eye(2)), q0=[0, 0], v0=[0, 0], t_span=(0, 1))

    @dataclass
    class Two(Made):
        def at(self, t):
            return tuple(np.hstack([x, -3.0 * x]) for x in super().at(t))

    a = Two(lambda t: t, lambda t: 1 + 0 * t, scene=plane)
    b = Two(lambda t: 0 * t, lambda t: 0 * t, t=(0.0, 0.5), scene=plane)
    d = Difference(a, b)
    assert d.span == (0.0, 0.5)
    assert (d.sup_position, d.l1_velocity) == (pytest.approx(1.5), pytest.approx(1.5))
    assert Difference(a, b, t_end=0.25).sup_position == pytest.approx(0.75)
    with pytest.raises(ValueError, match="coordinates"):
        Difference(a, step_up(0.4))
    with pytest.raises(ValueError, match="in common"):
        Difference(a, b, t_end=-1.0)


def test_balls_dropped_from_two_heights_differ_as_their_parabolas_do():
    h0, d, g = 1.0, 1e-4, 9.81
    runs = [simulate(scenes.bouncing_ball(h0=h, t_end=0.8), EventDriven()) for h in (h0 + d, h0)]
    fall, late = (math.sqrt(2 * h / g) for h in (h0, h0 + d))
    delay, found = late - fall, Difference(*runs)
    after = 0.8 * g * (late - fall)  # rebounds a little faster
    assert found.impact_time == pytest.approx(delay, rel=1e-9)
    assert found.impact_impulse == pytest.approx(1.8 * g * delay, rel=1e-9)
    # in flight the velocities differ by g delay (1 + 0.8); between the two impacts by about the whole jump
    between = delay * 1.8 * g * (fall + delay / 2) - 0.5 * 1.8 * g * delay**2
    assert found.l1_velocity == pytest.approx(between + (after + g * delay) * (0.8 - late), rel=1e-3)
    assert max(getattr(Difference(runs[0], runs[0]), name) for name in MEASURES) < 1e-15


@pytest.mark.slow
def test_states_of_time_stepping_come_close_in_every_measure():
    scene = scenes.impact_oscillator(t_end=20.0)
    exact, coarse, fine = (simulate(scene, m) for m in (EventDriven(), Moreau(1e-3), Moreau(3e-5)))
    for name in MEASURES:
        if name != "unmatched":
            assert getattr(Difference(fine, exact), name) < 0.1 * getattr(Difference(coarse, exact), name)
    assert Difference(fine, exact).unmatched == 0


@pytest.mark.parametrize(
    ("scene", "h"),
    [
        (scenes.impact_oscillator(t_end=20.0), 1.25e-4),
        (scenes.bouncing_ball(t_end=2.5), 1.5e-5),
        (scenes.cam_follower(rpm=358.0, t_end=0.5), 3e-6),
    ],
    ids=lambda x: getattr(x, "name", None),
)
@pytest.mark.parametrize("method", slow([Moreau, Located], longest=[Located]))
def test_a_part_of_a_fine_grid_tells_what_all_of_it_does(scene, h, method, monkeypatch):
    monkeypatch.setattr(errors, "MOST", 10**9)
    run, exact = simulate(scene, method(h)), simulate(scene, EventDriven(1e-13, 1e-13))
    whole = Difference(run, exact, least=1e-4)
    expected = {name: getattr(whole, name) for name in MEASURES}
    monkeypatch.setattr(errors, "MOST", 20_000)
    part = Difference(run, exact, least=1e-4)
    assert len(part._breaks) < 0.3 * len(whole._breaks)
    for name in MEASURES:
        assert getattr(part, name) == pytest.approx(expected[name], rel=1e-2, abs=1e-13), name


# --- graphs against brute force

points = st.lists(st.floats(-5, 5, allow_nan=False), min_size=2, max_size=12)


def brute(a, b, n=200):
    """Hausdorff distance of two polylines from many points on each."""

    def dense(p):
        s = np.linspace(0, 1, n)[:, None]
        return np.concatenate([p[i] + s * (p[i + 1] - p[i]) for i in range(len(p) - 1)])

    x, y = dense(a), dense(b)
    d = np.hypot(*(x[:, None, k] - y[None, :, k] for k in (0, 1)))
    return max(d.min(axis=1).max(), d.min(axis=0).max())


@pytest.mark.slow
@settings(max_examples=15, deadline=None)
@given(points, points, st.randoms(use_true_random=False))
def test_the_distance_of_polylines_is_that_of_their_points(a, b, random):
    a, b = (np.column_stack([sorted(random.choice(range(9)) for _ in v), v]) for v in (a, b))
    found, again = (hausdorff(Graph(*x.T), Graph(*y.T)) for x, y in ((a, b), (b, a)))
    assert found == pytest.approx(again, rel=1e-5, abs=1e-12)
    spacing = 13.0 / 200
    assert brute(a, b) - spacing <= found <= brute(a, b) + spacing
    assert hausdorff(Graph(*a.T), Graph(*a.T)) == 0.0


@settings(max_examples=20, deadline=None)
@given(points, points, st.floats(0.0, 20.0))
def test_what_is_nearer_than_is_asked_is_not_looked_for(a, b, least):
    a, b = (np.column_stack([np.arange(len(v)), v]) for v in (a, b))
    whole = hausdorff(Graph(*a.T), Graph(*b.T))
    assert hausdorff(Graph(*a.T), Graph(*b.T), least) == pytest.approx(max(whole, least), rel=2e-6, abs=1e-12)


@pytest.mark.parametrize("method", [Located(0.111, order="exact"), Located(0.02, order=4)])
def test_runs_that_take_a_time_just_before_an_impact_for_its_own_are_no_further_apart(method):
    scene = scenes.bouncing_ball(h0=1.0, g=10.0, restitution=0.8, t_end=3.0)
    apart = Difference(simulate(scene, method), simulate(scene, EventDriven()))
    assert apart.sup_position < 1e-14
    assert apart.graph_distance < 1e-12


def test_the_distance_of_graphs_is_that_of_the_farthest_coordinate():
    scene = scenes.elastic_gas(n=4)
    apart = Difference(simulate(scene, Moreau(1e-2)), simulate(scene, Moreau(1e-3)))
    t, v, v_ref = apart._graphs
    each = [hausdorff(Graph(t, x), Graph(t, y)) for x, y in zip(v.T, v_ref.T, strict=True)]
    assert apart.graph_distance == pytest.approx(max(each), rel=2e-6)
    assert min(each) < 0.9 * max(each)


def test_long_graphs_are_as_far_apart_as_one_of_them_was_moved():
    t = np.linspace(0.0, 100.0, 20_001)
    v = np.sign(np.sin(t)) + 0.1 * np.sin(7 * t)
    for shift in (1e-12, 1e-6, 1e-2, 0.3):
        assert hausdorff(Graph(t, v), Graph(t, v + shift)) <= shift * (1 + 1e-6) + 1e-15
        # a horizontal piece at the end sees the whole shift
        t2, v2 = np.append(t, 200.0), np.append(v, v[-1])
        assert hausdorff(Graph(t2, v2), Graph(t2, v2 + shift)) == pytest.approx(shift, rel=2e-4)


def test_a_detour_between_two_neighbouring_numbers_is_found():
    """Nothing lies between them, so that the piece of the straight graph there cannot be halved."""
    x = 5.0
    after = np.nextafter(x, 6.0)
    straight, detour = Graph([0, 6], [0, 0]), Graph([0, x, x, after, after, 6], [0, 0, 1, 1, 0, 0])
    assert hausdorff(straight, detour) == hausdorff(detour, straight) == pytest.approx(1.0)


# --- impacts against every pairing

times = st.lists(st.integers(0, 40), max_size=5).map(lambda x: np.sort(np.array(x)) / 4.0)


@settings(max_examples=60, deadline=None)
@given(times, times, st.sampled_from([0.6, 1.3, 20.0]))
def test_the_best_pairing_of_all_is_found(a, b, within):
    best = 0.0
    for k in range(1, min(len(a), len(b)) + 1):
        for i, j in itertools.product(itertools.combinations(a, k), itertools.combinations(b, k)):
            apart = np.abs(np.subtract(i, j))
            if np.all(apart <= within):
                best = max(best, np.sum(within - apart))
    m = match_impacts(log_of(a), log_of(b), 10.0, within)
    assert np.sum(within - np.abs(m.time)) == pytest.approx(best, abs=1e-12)
    assert len(m.pairs) + m.extra == len(a)
    assert len(m.pairs) + m.missing == len(b)
    assert np.all(np.diff(m.pairs, axis=0) > 0)
    assert np.all(np.abs(m.time) <= within)


def test_contacts_are_matched_apart_and_weak_impacts_left_out():
    a = log_of([1.0, 2.0, 3.0], [1.0, 2.0, 1e-9], [0, 1, 0])
    b = log_of([1.01, 2.02], [1.5, 2.0], [0, 0])
    m = match_impacts(a, b, 3.0, within=0.5, least=1e-6)
    assert m.pairs.tolist() == [[0, 0]]
    assert (m.extra, m.missing) == (1, 1)
    np.testing.assert_allclose(m.time, [-0.01])
    np.testing.assert_allclose(m.impulse, [-0.5])


def test_too_many_possible_pairs_are_refused_by_name():
    t = np.linspace(0, 1, 20_000)
    with pytest.raises(ValueError, match="within"):
        match_impacts(log_of(t), log_of(t), 1.0, within=1.0)
    assert match_impacts(log_of(t), log_of(t + 1e-6), 1.0).max_time == pytest.approx(1e-6, rel=1e-6)
