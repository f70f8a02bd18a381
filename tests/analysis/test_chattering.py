"""Where chattering sequences of the cam-follower end: against 110 digits, at corners of the cam above all."""

import numpy as np
import pytest
from mpmath import mp

from lagrangian import LinearContacts, Scene, System, scenes
from lagrangian.profiles import rotating_cam
from lcpstep import EventDriven, Kind, simulate
from lcpstep.analysis.chattering import corner_crossings, plain, sequences
from tests.cam_sequences import sequences as exact_sequences
from tests.marks import shared

# Speeds at which the end of a sequence meets a corner, by bisection of `cam_sequences` [rpm]
FLAT = 119.712481039598336  # nose to top dwell, on the way up; the cam presses on both sides
EDGE = 136.312372392873732  # top dwell to nose: beyond it the cam falls away, and the sequence goes on
LAST = 198.560511431792319  # flank to nose, one turn later: beyond it no sequence ends
MEETINGS = [(FLAT, 2), (EDGE, 3), (LAST, 1)]


def resting(rpm):
    return scenes.cam_follower(rpm=rpm, q0=0.0, v0=0.0)


def spring(t, q, v, p, out):
    out[0] = -1430.8 * q[0]


def two_springs(t, q, v, p, out):
    out[0], out[1] = -1430.8 * q[0], -1500.0 * q[1]


def two_cams(t, q, v, p, out):
    rotating_cam(t, q, v, p, out)
    for k in range(3):
        out[1, k] = out[0, k]


def general(rpm, force=spring, motion=rotating_cam, n=1):
    """The same follower, or n on one cam, as a general system, which is integrated by a Runge-Kutta method."""
    made = scenes.cam_follower(rpm=rpm, q0=0.0, v0=0.0, coordinates="absolute")
    return Scene(
        system=System(n_q=n, mass=1.221 * np.eye(n), force=force),
        contacts=LinearContacts(G=np.eye(n), restitution=0.8, motion=motion),
        q0=[made.q0[0]] * n, v0=[made.v0[0]] * n, t_span=made.t_span, p=made.p, corners=made.corners,
        period=made.period,
    )  # fmt: skip


def assert_sequences_are_exact(rpm, turns, method=None, most=100):
    cam, exact = exact_sequences(rpm, turns, most)
    found = sequences(resting(rpm), method)[:most]
    ended = [s for s in exact if s[2] is not None][: len(found)]
    assert len(found) == len(ended) > 0
    with mp.workdps(30):
        for s, (release, impacts, end) in zip(found, ended, strict=True):
            assert s.release == pytest.approx(float(release / cam.period % 1), abs=1e-14)
            assert s.accumulation == pytest.approx(float(end / cam.period % 1), abs=4e-12)
            followed = [float(t / cam.period % 1) for t, _ in impacts[: len(s.impacts)]]
            np.testing.assert_allclose(s.impacts, followed, rtol=0, atol=4e-12)


@pytest.mark.parametrize("rpm", shared([119.7125, 115.0], 2))
def test_sequences_that_end_near_a_corner_agree_with_many_digits(rpm):
    assert_sequences_are_exact(rpm, 1, most=1)


SLOW_CAMS = [114.98, 115.2, 118.0, 119.7, 119.712, 119.71248, 119.7125, 119.713, 119.73]


@pytest.mark.parametrize("rpm", shared(SLOW_CAMS, 9))
def test_sequences_of_slow_cams(rpm):
    for method in (EventDriven(), EventDriven(rtol=1e-13, atol=1e-14)):  # before one and the same reference
        assert_sequences_are_exact(rpm, 1, method)


FASTER_CAMS = [
    160.0, 134.9, 136.3, 136.37, 136.4, 171.0, 172.0, 175.0, 178.0, 180.0, 191.0, 195.0, 198.0, 198.56,
]  # fmt: skip


@pytest.mark.parametrize("rpm", shared(FASTER_CAMS, 14))
def test_sequences_of_faster_cams(rpm):
    assert_sequences_are_exact(rpm, 2)


@pytest.mark.thorough
@pytest.mark.parametrize("meeting", MEETINGS)
def test_the_speeds_above_are_those_at_which_a_sequence_ends_on_the_corner(meeting):
    speed, corner = meeting

    def before_the_corner(rpm):
        cam, found = exact_sequences(rpm, 2, 1)
        n = corner if speed != LAST else corner + 6
        return found[0][2] is not None and found[0][2] < cam.corner(n)

    assert before_the_corner(speed * (1 - 2e-14))
    assert not before_the_corner(speed * (1 + 2e-14))


@pytest.mark.parametrize(("speed", "corner"), MEETINGS)
@pytest.mark.parametrize(
    "width",
    [
        pytest.param((0.03, 0.02), marks=pytest.mark.thorough),
        pytest.param((1e-3, 2e-3), marks=pytest.mark.slow),
        pytest.param((1e-6, 1e-6), marks=pytest.mark.slow),
    ],
)
def test_the_end_of_a_sequence_meets_the_corner_at_that_speed_from_both_sides(speed, corner, width):
    low, high = speed - width[0], speed + width[1]
    found = corner_crossings(resting, (low, high), impacts=0)
    (meeting,) = [c for c in found if (c.event, c.corner, c.sequence) == ("accumulation", corner, 0)]
    assert meeting.p == pytest.approx(speed, rel=1e-12)


@pytest.mark.parametrize("meeting", shared([(1, 124.998296821), (3, 121.685871922), (5, 120.735577178)], 3))
def test_an_impact_meets_the_corner_where_many_digits_say(meeting):
    number, speed = meeting
    (found,) = [
        c.p
        for c in corner_crossings(resting, (speed - 0.3, speed + 0.2))
        if (c.event, c.number, c.corner) == ("impact", number, 2)
    ]

    def before_the_corner(rpm):
        cam, made = exact_sequences(rpm, 1, 1)
        return made[0][1][number - 1][0] < cam.corner(2)

    assert before_the_corner(found * (1 - 1e-12)) != before_the_corner(found * (1 + 1e-12))


@pytest.mark.slow
def test_crossings_close_together_are_told_apart():
    # A tooth of the accumulation point whose tip passes the corner f by little: a grid of 0.4 rpm saw none of the two
    found = corner_crossings(resting, (139.0, 140.0), impacts=0)
    pair = [c.p for c in found if (c.event, c.corner) == ("accumulation", 5)]
    np.testing.assert_allclose(pair, [139.417365794, 139.558681247], rtol=1e-11)
    for p in pair:  # wherever the range begins and ends
        again = corner_crossings(resting, (p - 1.3, p + 0.05), impacts=0)
        assert min(abs(c.p - p) for c in again) < 1e-9


@pytest.mark.slow
def test_two_crossings_a_ten_millionth_apart_are_two():
    half, first = 1e-5, 124.998296820803  # the first impact meets the corner c

    def there_and_back(p):
        return resting(first + 100.0 * ((p - 130.0) ** 2 - half**2))

    found = corner_crossings(there_and_back, (129.96, 130.05), impacts=1)
    pair = [c.p for c in found if (c.event, c.number, c.corner) == ("impact", 1, 2)]
    assert pair == pytest.approx([130.0 - half, 130.0 + half], abs=1e-7)


def test_parts_of_a_range_are_plain_where_events_keep_away_or_pass_once():
    def at(phases):
        return [({(0, "impact", 1): x}, np.array([0.5])) for x in phases]

    assert plain(at([0.1, 0.12, 0.14, 0.16, 0.18]))
    assert plain(at([0.48, 0.49, 0.5001, 0.51, 0.52]))
    assert not plain(at([0.48, 0.49, 0.499, 0.49, 0.48]))  # it may touch the corner between
    assert not plain([*at([0.1, 0.12, 0.14, 0.16]), ({}, np.array([0.5]))])
    assert plain(at([0.97, 0.98, 0.99, 0.0, 0.01]))  # over the end of the period


@pytest.mark.parametrize("apart", [1e-6, 1e-8, 1e-10])
def test_the_end_passes_a_corner_that_presses_on_both_sides_without_a_jump(apart):
    scene = resting(FLAT)
    corner = scene.corners[2] / scene.period
    before = sequences(resting(FLAT * (1 - apart)))[0].accumulation - corner
    after = sequences(resting(FLAT * (1 + apart)))[0].accumulation - corner
    assert -1.1 * apart < before < -0.9 * apart  # it moves by 0.96 turns, relative to the speed
    assert 0.1 * apart < after < apart  # beyond the corner it is pressed harder


@pytest.mark.parametrize("below", [1e-9, 1e-6, 1e-3])
@pytest.mark.parametrize("rpm", [114.9793, 114.98, 115.0, 115.05])
def test_no_release_is_without_impact(rpm, below):
    for s in sequences(resting(rpm * (1 + below))):
        assert len(s.impacts) > 0
        assert s.accumulation > s.release


@pytest.mark.parametrize("rpm", [118.0, 119.7124, 119.71248, 119.7125, 119.713, 136.3, 140.0])
def test_a_general_system_chatters_as_the_closed_form_does(rpm):
    closed, integrated = sequences(resting(rpm)), sequences(general(rpm))
    assert len(closed) == len(integrated) > 0
    for s, other in zip(closed, integrated, strict=True):
        assert other.release == pytest.approx(s.release, abs=1e-13)
        assert other.accumulation == pytest.approx(s.accumulation, abs=1e-11)


@pytest.mark.parametrize("rpm", [118.0, 119.7125, 136.3, 160.0])
def test_contacts_that_know_nothing_of_each_other_chatter_as_the_closed_form_does(rpm):
    both = simulate(general(rpm, two_springs, two_cams, 2), EventDriven(), keep="impacts").impacts
    for contact, k in enumerate((1430.8, 1500.0)):
        alone = simulate(
            scenes.cam_follower(rpm=rpm, q0=0.0, v0=0.0, k=k), EventDriven(), keep="impacts"
        ).impacts
        ends, expected = ((x.kind == Kind.STICK) & (x.contact == c) for x, c in ((both, contact), (alone, 0)))
        assert np.sum(expected) > 2
        # a first hop of 9e-5 s, which begins without speed, is known to 3e-12 s, and its sequence to 9e-11
        np.testing.assert_allclose(both.time[ends], alone.time[expected], rtol=0, atol=2e-10)
