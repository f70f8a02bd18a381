"""What is kept of a run, the times of its steps, and states in between."""

import math

import numpy as np
import pytest

from lagrangian import Contacts, LinearContacts, LinearSystem, Scene, scenes
from lcpstep import Located, Moreau, simulate
from lcpstep.stepping.pieces import run as pieces
from lcpstep.trajectory import Kind, Status
from tests.falling import FALLING, FLOOR
from tests.stepping.test_step import three_masses

H = 1e-3
SCENE = three_masses()


@pytest.fixture(scope="module")
def full():
    return simulate(SCENE, Moreau(H))


def assert_same_log(m, other):
    for name in ("time", "contact", "before", "after", "impulse", "kind"):
        np.testing.assert_array_equal(m.impacts[name], other.impacts[name])


def assert_rows_of(part, full):
    """Part's rows are rows of full, and its impulses the sums between them."""
    rows = np.searchsorted(full.t, part.t)
    for name in ("t", "q", "v"):
        np.testing.assert_array_equal(getattr(part, name), getattr(full, name)[rows])
    between = np.diff(np.cumsum(full.impulse, axis=0)[rows], axis=0)
    np.testing.assert_allclose(part.impulse[1:], between, rtol=0, atol=1e-13)
    assert_same_log(part, full)


def test_every_step_is_kept_by_default(full):
    assert full.t.shape == (4001,)
    assert full.q.shape == full.v.shape == (4001, 3)
    assert full.impulse.shape == (4001, 4)
    np.testing.assert_allclose(full.t, np.arange(4001) * H, rtol=0, atol=1e-15 * 4)
    assert full.t[0] == 0.0
    assert full.t[-1] == 4.0
    assert full.status is Status.DONE
    assert full.counts.steps == 4000
    assert full.counts.events == len(full.impacts)


@pytest.mark.parametrize("k", [2, 7, 100, 4000, 10**6])
def test_every_kth_step_and_the_last(full, k):
    part = simulate(SCENE, Moreau(H), keep=k)
    assert_rows_of(part, full)
    assert len(part.t) == 1 + 4000 // k + (1 if 4000 % k else 0)


def test_the_states_after_events(full):
    part = simulate(SCENE, Moreau(H), keep="impacts")
    assert_rows_of(part, full)
    expected = np.unique(np.concatenate([[0.0], full.impacts.time, [4.0]]))
    np.testing.assert_array_equal(part.t, expected)


def test_the_states_at_given_times(full):
    times = np.array([0.0, 0.01, 0.0105, 1.0, 1.2345678, 3.999, 4.0])
    part = simulate(SCENE, Moreau(H), keep=times)
    np.testing.assert_array_equal(part.t, times)
    q, v = full.at(times)
    np.testing.assert_allclose(part.q, q, rtol=0, atol=1e-14)
    # where a time falls onto a step, rounding decides which side of it an impact lies on: none of these
    np.testing.assert_allclose(part.v, v, rtol=0, atol=1e-12)
    assert_same_log(part, full)


@pytest.mark.parametrize("t_end", [1.0, 0.7, 2.3])
def test_the_end_of_the_span_is_among_the_given_times_however_it_rounds(t_end):
    scene = scenes.bouncing_ball(t_end=t_end)
    for n in range(1, 200):
        for h in (t_end / n, t_end / (n + 0.37)):
            assert list(simulate(scene, Moreau(h), keep=[0.0, t_end]).t) == [0.0, t_end]


def test_given_times_may_leave_out_start_and_end(full):
    part = simulate(SCENE, Moreau(H), keep=[0.5, 1.5])
    np.testing.assert_array_equal(part.t, [0.5, 1.5])
    # the first row's impulse is that since the start
    until = np.cumsum(full.impulse, axis=0)[np.searchsorted(full.t, [0.5 - 1e-9, 1.5 - 1e-9])]
    np.testing.assert_allclose(np.cumsum(part.impulse, axis=0), until, rtol=0, atol=1e-13)


@pytest.mark.parametrize(
    "keep",
    [0, -1, True, 2.5, "all", "impact", None, [], [1.0, 1.0], [2.0, 1.0], [-0.1, 1.0], [1.0, 4.1], [[0.0, 1.0]],
     [0.0, math.nan, 1.0], [math.nan], ["noon"], [1j]],
)  # fmt: skip
def test_what_cannot_be_kept_is_refused(keep):
    with pytest.raises(ValueError, match=r"^keep: "):
        simulate(SCENE, Moreau(H), keep=keep)


# --- the last step


@pytest.mark.parametrize("h", [0.3, 0.07, 0.0011, 1.0, 1.0 - 1e-6])
def test_the_last_step_is_shortened_to_end_with_the_span(h):
    m = simulate(scenes.bouncing_ball(t_end=1.0), Moreau(h))
    steps = np.diff(m.t)
    assert m.t[-1] == 1.0
    assert m.counts.steps == len(steps) == math.ceil(1.0 / h)
    np.testing.assert_allclose(steps[:-1], h, rtol=1e-12)
    assert 0.0 < steps[-1] <= h * (1 + 1e-12)


def test_free_fall_is_exact_in_the_shortened_step_too():
    m = simulate(scenes.bouncing_ball(t_end=0.4), Moreau(0.03, theta=0.5))
    np.testing.assert_allclose(m.q[:, 0], 1.0 - 0.5 * 9.81 * m.t**2, rtol=0, atol=1e-15 * len(m.t))


@pytest.mark.parametrize("n", [3, 7, 10, 1000, 12345])
def test_a_step_that_divides_the_span_up_to_rounding_leaves_no_rest(n):
    for h in (1.0 / n, np.nextafter(1.0 / n, 0.0), np.nextafter(1.0 / n, 1.0)):
        m = simulate(scenes.bouncing_ball(t_end=1.0), Moreau(float(h)))
        assert m.counts.steps == n
        assert m.t[-1] == 1.0


def test_spans_may_begin_anywhere():
    def ball(t_start):
        return Scene(
            system=LinearSystem(M=1.0, force=-8.0), contacts=LinearContacts(G=1.0, restitution=0.5),
            q0=1.0, v0=0.0, t_span=(t_start, t_start + 2.0),
        )  # fmt: skip

    first, later = (simulate(ball(t), Moreau(2.0**-10)) for t in (0.0, -5.0))
    np.testing.assert_array_equal(first.q, later.q)
    np.testing.assert_array_equal(first.t - 5.0, later.t)
    np.testing.assert_array_equal(first.impacts.time - 5.0, later.impacts.time)


@pytest.mark.slow
def test_ten_million_steps_need_few_rows():
    m = simulate(scenes.impact_oscillator(t_end=100.0), Moreau(1e-5), keep=10**6)
    assert m.counts.steps == 10**7
    assert len(m.t) == 11


# --- between steps


def test_states_between_steps_lie_on_the_straight_line(full):
    k = np.array([0, 17, 2000, 3999])
    for share in (0.0, 0.25, 0.5, 0.99):
        q, v = full.at(full.t[k] + share * (full.t[k + 1] - full.t[k]))
        # shares are known to rounding of t over h
        np.testing.assert_allclose(q, full.q[k] + share * (full.q[k + 1] - full.q[k]), rtol=0, atol=1e-13)
        np.testing.assert_allclose(v, full.v[k] + share * (full.v[k + 1] - full.v[k]), rtol=0, atol=1e-11)


def test_a_single_time_gives_a_single_state(full):
    q, v = full.at(1.0)
    assert q.shape == v.shape == (3,)
    np.testing.assert_array_equal(full.at([4.0])[0][0], full.q[-1])


@pytest.mark.parametrize(("t", "said"), [
    (-1e-9, "times within"), (4.0 + 1e-9, "times within"), (math.nan, "finite"), (math.inf, "finite"),
    ([1.0, 5.0], "times within"),
])  # fmt: skip
def test_times_outside_the_run_are_refused(full, t, said):
    with pytest.raises(ValueError, match=f"^t: expected {said}"):
        full.at(t)


def test_states_that_were_not_kept_are_not_made_up():
    part = simulate(SCENE, Moreau(H), keep=100)
    np.testing.assert_array_equal(part.at(part.t)[0], part.q)
    with pytest.raises(ValueError, match=r"^t: .*not known"):
        part.at(0.05)


def test_logs_longer_than_the_buffer_are_complete():
    # elastic ball, rising for 27 steps after each impact: more events than a buffer holds
    scene = scenes.bouncing_ball(h0=0.25, g=8.0, restitution=1.0, t_end=4000.0)
    log = simulate(scene, Moreau(0.02, theta=0.5), keep="impacts").impacts
    assert np.all(log.kind == Kind.IMPACT)
    assert len(log) > 4096
    assert np.all(np.diff(log.time) > 0.0)


def test_states_soon_after_the_start_cost_no_run_to_the_end(monkeypatch):
    """Orders above 2 are run again for the states between kept ones, as far as these are asked for."""
    run = simulate(scenes.impact_oscillator(t_end=100.0), Located(1e-3, order=4))
    taken, take = [], pieces.LocatedRun.take
    monkeypatch.setattr(pieces.LocatedRun, "take", lambda self, last: taken.append(last) or take(self, last))
    early = run.at([0.0, 0.01])
    first = len(taken)
    whole = run.at([0.0, 0.01, 99.0])
    assert len(taken) - first > 5 * first
    np.testing.assert_array_equal(early[0], whole[0][:2])
    np.testing.assert_array_equal(early[1], whole[1][:2])
    assert run.at(np.array([]))[0].shape == (0, 1)


def test_an_interrupt_while_states_are_found_again_is_one(monkeypatch):
    run = simulate(scenes.bouncing_ball(t_end=1.0), Located(1e-3, order=4))

    def interrupted(self, last):
        raise KeyboardInterrupt

    monkeypatch.setattr(pieces.LocatedRun, "take", interrupted)
    with pytest.raises(KeyboardInterrupt):
        run.at([0.5])


def asked_of_a_bowl(times):
    """How often the gap of a ball in a bowl is asked for, and the run, by a tolerance, that keeps these times."""
    calls = [0]

    def bowl(t, q, v, p, out):
        calls[0] += 1
        out[0] = 1.0 - np.hypot(q[0], q[1])

    def bowl_q(t, q, v, p, out):
        out[0, :] = -q / np.hypot(q[0], q[1])

    def bias(t, q, v, p, out):
        r = np.hypot(q[0], q[1])
        out[0] = (((q[0] * v[0] + q[1] * v[1]) / r) ** 2 - v[0] ** 2 - v[1] ** 2) / r

    contacts = Contacts(gap=bowl, jacobian=bowl_q, bias=bias, n_c=1, restitution=0.9)
    ball = LinearSystem(M=np.eye(2), force=[0.0, -9.81])
    scene = Scene(ball, contacts=contacts, q0=[0.1, -0.9], v0=[0.0, 0.0], t_span=(0.0, 2.0))
    run = simulate(scene, Located(0.5, tolerance=1e-2), keep=times)
    return calls[0], run


@pytest.mark.slow
@pytest.mark.filterwarnings("ignore")
def test_states_asked_for_ahead_of_many_short_steps_are_made_once():
    (few, run), (many, more) = asked_of_a_bowl([1.0, 2.0]), asked_of_a_bowl(np.linspace(1.75, 2.0, 500))
    assert np.array_equal(run.q[-1], more.q[-1])
    assert many - few < 4 * 500


@pytest.mark.parametrize(
    "method", [Located(1e-2), Located(1e-2, order=4), Located(1e-2, order="exact")], ids=repr
)
def test_an_impact_at_rounding_after_a_step_is_in_the_state_of_its_time(method):
    """The ball strikes at t = 1/2 and 1, where steps end, to rounding; it leaves with 2 and 1 m/s."""
    scene = Scene(FALLING, 1.0, 0.0, (0.0, 1.2), FLOOR)
    run = simulate(scene, method)
    times = run.impacts.time
    np.testing.assert_allclose(times, [0.5, 1.0], rtol=1e-15)
    for v in (run.at(times)[1], simulate(scene, method, keep=times).v):
        np.testing.assert_allclose(v[:, 0], [2.0, 1.0], rtol=1e-12)


def billiard(mass, q, v, length, times):
    """Elastic points on a line between walls at 0 and `length`, impact by impact: the states asked for."""
    q, v, now, found = q.copy(), v.copy(), 0.0, []
    while len(found) < len(times):
        gap, speed = np.diff(q, prepend=0.0, append=length), np.diff(v, prepend=0.0, append=0.0)
        wait = np.where(speed < 0.0, gap / np.where(speed < 0.0, -speed, 1.0), np.inf)
        c = int(np.argmin(wait))
        while len(found) < len(times) and times[len(found)] < now + wait[c]:
            found.append(q + (times[len(found)] - now) * v)
        q, now = q + wait[c] * v, now + wait[c]
        both = slice(max(c - 1, 0), c + 1)  # the bodies of gap c; a wall stands still
        share = (1.0 / mass[both]).sum()
        toward = -1.0 if c == len(q) else 1.0
        v[both] += (
            np.array([-1.0, 1.0] if 0 < c < len(q) else [toward]) * -2.0 * speed[c] / share / mass[both]
        )
    return np.array(found)


@pytest.mark.parametrize("method", [Located(0.1), Located(0.5, tolerance=1e-6)])
def test_states_asked_for_between_impacts_in_turn_change_none_of_them(method):
    rng, n = np.random.default_rng(5), 12
    mass, q, v = rng.uniform(0.5, 2.0, n), np.arange(n) + rng.uniform(0.2, 0.8, n), rng.normal(size=n)
    G, offset = np.eye(n + 1, n) - np.eye(n + 1, n, -1), np.append(np.zeros(n), float(n))
    walls = LinearContacts(G, offset, restitution=1.0)
    gas = Scene(LinearSystem(np.diag(mass)), q, v, (0.0, 10.0), contacts=walls)
    times = np.linspace(0.0, 10.0, 777)
    ends, kept = (simulate(gas, method, keep=keep) for keep in (10**6, times))
    assert len(ends.impacts) > 50
    assert_same_log(kept, ends)
    np.testing.assert_allclose(kept.q, billiard(mass, q, v, float(n), times), rtol=0, atol=1e-11)
    for c in range(n + 1):
        log = kept.impacts[kept.impacts.contact == c]
        logged = np.histogram(log.time, times, weights=log.impulse)[0]
        np.testing.assert_allclose(kept.impulse[1:, c], logged, rtol=0, atol=1e-12)
