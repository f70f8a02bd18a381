"""The judge asks for no more than a method, or a law, can promise, and for all of that."""

from dataclasses import replace

import numpy as np
import pytest

from benchmarks.judge import agree, checks
from benchmarks.judge.agree import Reference, agrees
from benchmarks.judge.checks import between, check, depth, finite, gain, given_by_the_law, penetration
from benchmarks.judge.describe import Description
from benchmarks.judge.physics import gaps, room, swinging
from benchmarks.judge.runs import run
from benchmarks.judge.variants import VARIANTS, Variant
from benchmarks.judge.vary import base, jams, nearest, same


def kinds(findings):
    return {x.kind for x in findings}


@pytest.mark.parametrize(("speed", "excused"), [(1.0, False), (300.0, True)])
def test_steps_may_break_down_only_where_the_wall_turns_within_one(speed, excused):
    d = Description(
        M=((1.0, 0.0), (0.0, 1.0)), q0=(0.0, -1.0), v0=(speed, 0.0), t_span=(0.0, 0.05), h=0.01, G=((0.0, 0.0),),
        offset=(0.5,), bend=(-1.0,), round=(0.0,),
    )  # fmt: skip
    r = replace(run(d, "located-4"), status="NOT_FINITE")
    assert ("not finite" in kinds(finite(d, r))) is not excused


@pytest.mark.parametrize(("speed", "excused"), [(1.0, False), (300.0, True)])
def test_the_last_step_of_a_run_may_lead_elsewhere_only_where_the_wall_turns_within_one(speed, excused):
    d = Description(
        M=((1.0, 0.0), (0.0, 1.0)), q0=(0.0, -1.0), v0=(speed, 0.0), t_span=(0.0, 0.05), h=0.01, G=((0.0, 0.0),),
        offset=(0.5,), bend=(-1.0,), round=(0.0,),
    )  # fmt: skip
    r = run(d, "located-4")
    q = r.motion.q.copy()
    q[-1] += 0.1
    r = replace(r, status="NOT_FINITE", motion=replace(r.motion, q=q))
    assert ("no states between" in kinds(between(d, r))) is not excused


@pytest.mark.parametrize(("light", "excused"), [(1.0, False), (1e-4, True)])
def test_steps_may_break_down_only_where_what_joints_carry_swings_within_one(light, excused):
    """A weight of 9.81 N that hangs on a rod of 1 m swings with the square root of 9.81 / mass along its arc."""
    d = Description(
        M=((light, 0.0), (0.0, 1.0)), q0=(0.0, -1.0), v0=(0.0, 0.0), t_span=(0.0, 0.05), h=0.01,
        constant=(0.0, -9.81), J=((0.0, 0.0),), joint_offset=(-0.5,), joint_bend=(1.0,),
    )  # fmt: skip
    assert swinging(d, np.array(d.q0), np.array([-9.81])) == pytest.approx(np.sqrt(9.81 / light))
    r = replace(run(d, "located-4"), status="NOT_FINITE")
    assert ("not finite" in kinds(finite(d, r))) is not excused


CLOSING = Description(
    M=((0.512, 0.0, 0.0), (0.0, 2.28, 0.0), (0.0, 0.0, 1.75)), q0=(0.0, 0.0, 0.0), v0=(0.0, 0.0, 0.0),
    t_span=(0.0, 2.0), h=0.0698, G=((0.0, 0.0, 0.0),), offset=(0.2003334021718558,), K=((0.0192, -0.0467,
    -0.00065), (-0.0467, 0.211, -0.117), (-0.00065, -0.117, 0.148)), C=((0.00466, -0.00606, -8.43e-05), (-0.00606,
    0.0371, -0.0152), (-8.43e-05, -0.0152, 0.0265)), constant=(0.0, 0.0, -17.2), force_omega=0.405,
    amplitude=(0.212,), phase=(0.493,), omega=0.948, bend=(-0.429,), round=(0.0,), general=True, spread=0.131,
    pendulum=0.191, b=(-1.12, 0.38, -1.02), family="curved",
)  # fmt: skip


@pytest.mark.parametrize(("time", "excused"), [(0.6, False), (0.8, True)])
def test_steps_that_break_down_may_lie_in_a_wall_only_from_there_on(time, excused, monkeypatch):
    """A bowl that shrinks to nothing about a body, at 0.785 s: it turns about in less than a step from 0.727 s on."""
    r = run(CLOSING, "located-4")
    assert r.status == "NOT_FINITE"
    q = np.where((r.motion.t > time)[:, None], 3.0, 0.3) * r.motion.q
    deep = replace(r, motion=replace(r.motion, q=q))
    finer = {"located-4": deep, "event-driven": run(CLOSING, "event-driven")}
    monkeypatch.setattr(checks, "run", lambda d, name, factor=1.0: finer[name])
    assert depth(CLOSING, deep) > 0.1
    assert ("penetration" in kinds(penetration(CLOSING, deep))) is not excused


@pytest.mark.parametrize(("faster", "found"), [(1.0, set()), (1e5, {"other events: span in two parts"})])
def test_impacts_slower_than_velocities_are_promised_need_no_partner(faster, found):
    d = Description(
        M=((0.943, 0.0), (0.0, 0.963)), q0=(0.0, 0.0), v0=(0.0, 0.0), t_span=(0.0, 0.1944), h=0.0324,
        G=((0.00141, -1.28), (-1.26, 0.573)), offset=(0.97, 0.432), restitution=0.36, K=((2.37, -3.0), (-3.0, 7.81)),
        constant=(0.0, -9.45), frame=(-0.00118, -9.12e-05), omega=2.77, bend=(-0.97, -0.432), round=(1.0, 1.0),
    )  # fmt: skip
    r = run(d, "located-tolerance")
    q, v = r.motion.at(0.0648)  # on its surface to rounding, and along it to within the tolerance
    part = replace(d, q0=tuple(q), v0=tuple(v), t_span=(0.0648, 0.1944))
    other = run(part, "located-tolerance")
    log = other.motion.impacts.copy()
    log.before[:] = faster * log.before
    other = replace(other, motion=replace(other.motion, impacts=log))
    assert 0.0 < np.max(np.abs(log.before)) < 1.0
    assert kinds(same(base(d, r), other, Variant("span in two parts", part))) == found


@pytest.mark.parametrize(("faster", "found"), [(1.0, set()), (1e4, {"other events: span in two parts"})])
def test_a_fall_from_a_gap_of_rounding_needs_no_partner(faster, found):
    d = Description(
        M=((1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0)), q0=(0.0,) * 3, v0=(0.0,) * 3, t_span=(0.0, 0.0313702),
        h=0.00023, G=((-1.74, -2.3, 0.748),), offset=(0.1284,), restitution=0.75, K=((4180.0, 2510.0, 411.0),
        (2510.0, 27300.0, 1920.0), (411.0, 1920.0, 181.0)), constant=(0.0, 0.0, -9.81), bend=(-0.428,), round=(0.3,),
        general=True, spread=0.93, pendulum=0.364, b=(-0.445, 0.298, 0.61),
    )  # fmt: skip
    r = run(d, "located-4")
    q, v = r.motion.at(0.01173)
    part = replace(d, q0=tuple(q), v0=tuple(v), t_span=(0.01173, 0.0313702))
    assert 0.0 < gaps(part, 0.01173, q)[0] < 1e-15
    other = run(part, "located-4")
    log = other.motion.impacts.copy()
    log.before[:] = faster * log.before
    other = replace(other, motion=replace(other.motion, impacts=log))
    assert 1e-8 < np.max(np.abs(log.before)) < 1.0
    assert kinds(same(base(d, r), other, Variant("span in two parts", part))) == found


def test_energy_that_moreaus_law_gives_at_different_restitutions_is_no_anomaly():
    d = Description(
        M=((1.47, 0.0572, 0.18, 0.152), (0.0572, 0.345, 0.0875, 0.0737), (0.18, 0.0875, 3.43, 0.233),
        (0.152, 0.0737, 0.233, 2.44)), q0=(0.0,) * 4, v0=(-0.228, 0.0399, 0.0166, -0.131), t_span=(0.0, 0.06832),
        h=0.00976, G=((1.01, -1.04, 1.4, -0.312), (-0.573, -1.02, -1.84, -1.33), (0.512, 0.0203, -0.935, -0.469),
        (-0.278, 0.223, -0.0135, 0.093), (1.47, 0.28, 0.245, 1.04), (-1.27, 1.08, 0.293, -1.39), (0.00846, 1.41,
        -0.218, 0.189), (0.104, -1.6, 0.288, 0.668)), offset=(0.0,) * 8, restitution=(0.93, 0.0, 1.0, 0.64, 0.69,
        0.034, 1.0, 0.56), K=((7.82, -4.07, 4.22, -2.3), (-4.07, 3.98, -10.6, 0.594), (4.22, -10.6, 86.1, 20.5),
        (-2.3, 0.594, 20.5, 19.7)), constant=(0.25, -0.298, -0.00833, -1.06), general=True,
    )  # fmt: skip
    r = run(d, "moreau")
    # a contact leaves the obstacle as slowly as forces make it, and is pressed back by the blow on another; of those
    # that leave faster the law had given 1.3e-3 here
    given = given_by_the_law(d, r)
    assert 0.0 < given < 1e-5
    assert abs(gain(d, r)) < 1e-15
    assert "energy gained" not in kinds(check(d, r))
    one = replace(d, restitution=0.5)
    assert given_by_the_law(one, run(one, "moreau")) == 0.0
    assert given_by_the_law(d, run(d, "located")) == 0.0


@pytest.mark.parametrize(("width", "jammed"), [(0.0, True), (1e-3, False)])
def test_impulses_may_be_wanting_only_where_walls_leave_no_room(width, jammed):
    """A bead between two walls, or three in a row."""
    for rows in (((1.0,), (-1.0,)), ((-1.0, 1.0), (1.0, 0.0), (0.0, -1.0))):
        n = len(rows[0])
        d = Description(
            M=tuple(map(tuple, np.eye(n))), q0=(0.0,) * n, v0=(0.0,) * n, t_span=(0.0, 0.1), h=0.01, G=rows,
            offset=(width, *(0.0,) * (len(rows) - 1)), restitution=0.5, constant=(1.0,) * n,
        )  # fmt: skip
        r = run(d, "event-driven")
        assert not jams(d, r)  # it has ended well
        assert jams(d, replace(r, status="LCP_FAILED")) is jammed
    assert room(replace(d, G=rows[:2], offset=(0.0, 0.0), restitution=0.5), 0.0) == np.inf


@pytest.mark.parametrize("method", ["event-driven", "event-driven-loose"])
@pytest.mark.parametrize(("clearance", "known"), [(0.0, False), (0.01, True), (-0.01, True)])
def test_a_motion_is_told_until_it_grazes(method, clearance, known):
    """A body on a spring, let go at rest, comes back to that place after a period; a wall may stand just there."""
    d = Description(
        M=((1.0,),), q0=(-1.0,), v0=(0.0,), t_span=(0.0, 10.0), h=0.05, G=((1.0,),), offset=(1.0,), restitution=0.5,
        K=((1.0,),),
    )  # fmt: skip
    if clearance:  # a wall on the other side, which is reached after half a period
        d = replace(d, G=((-1.0,),), offset=(1.0 + clearance,))
    found = base(d, run(d, method)).grazes
    assert found == (np.inf if known else pytest.approx(2.0 * np.pi, abs=1e-4))


def test_the_nearest_of_a_million_impacts_is_found_at_once():
    rng = np.random.default_rng(0)
    times, to = rng.uniform(0.0, 1.0, 300), rng.uniform(-0.1, 1.1, 200)
    wanted = np.min(np.abs(times[:, None] - to), axis=0)
    np.testing.assert_array_equal(nearest(times, to), wanted)
    assert np.all(nearest(times[:0], to) == np.inf)
    many = np.arange(10**6) * 1e-6
    assert np.all(nearest(many, many) == 0.0)


@pytest.mark.slow
def test_impacts_are_told_until_companions_strike_in_another_order():
    """A body that comes to rest in the apex of four walls, from a millimetre off, between two looks at its places."""
    d = Description(
        M=((0.433, 0.144, 0.159), (0.144, 2.07, 0.347), (0.159, 0.347, 2.5)), q0=(0.646, -0.932, -0.0594),
        v0=(-0.839, 0.249, -0.0372), t_span=(0.0, 60.0), h=0.0628, G=((0.227, -0.578, 0.784),
        (0.345, 0.136, 0.929), (-0.266, 0.678, 0.686), (-0.855, -0.336, 0.396)), offset=(-0.6379844,
        -0.04000639999999998, 0.8451664000000001, 0.26309639999999995), restitution=0.88, K=((0.141, -0.297, -0.391),
        (-0.297, 1.44, 0.649), (-0.391, 0.649, 1.38)), C=((0.148, -0.00152, -0.00201), (-0.00152, 0.713, 0.00333),
        (-0.00201, 0.00333, 0.861)), constant=(0.0, 0.0, -24.5),
    )  # fmt: skip
    r, rng = run(d, "located-exact"), np.random.default_rng(3)
    b, v = base(d, r), VARIANTS["order"](d, rng)
    assert b.told == np.inf  # its places
    assert 0.4 < b.alone < 0.7
    other = run(v.scene, "located-exact")
    assert kinds(same(b, other, v)) == set()
    log = np.delete(other.motion.impacts, 5).view(np.recarray)  # at t = 0.117
    other = replace(other, motion=replace(other.motion, impacts=log))
    assert kinds(same(b, other, v)) == {"other events: coordinates renumbered"}


def test_a_contact_may_let_go_where_its_step_begins_whatever_the_step(monkeypatch):
    """After 4e-4 s; steps of h to h/16 all have it at 0, and are 1e-8 off together."""
    d = Description(
        M=((291.0, 0.0, 0.0), (0.0, 9390.0, 0.0), (0.0, 0.0, 0.197)), q0=(-0.13, -0.253, 0.302), v0=(0.0,) * 3,
        t_span=(0.0, 0.363), h=0.011, G=((-0.953, -0.105, 0.285), (0.546, -0.743, 0.388), (0.393, 0.896, 0.208)),
        offset=(-0.23652499999999999, -0.234175, 0.21496200000000004), restitution=(0.86, 0.19, 1.0),
        constant=(0.0, 0.0, -1.93), frame=(0.0987, -0.0618, 0.112), omega=2.85,
    )  # fmt: skip
    r, reference = run(d, "located"), Reference(d, run(d, "event-driven"))
    assert np.max(np.abs(run(d, "located", 0.25).motion.at(0.044)[0] - r.motion.at(0.044)[0])) < 1e-15
    assert agrees(reference, r) == []

    def shaken(d, method, factor=1.0):
        return run(replace(d, frame=(0.0988, -0.0618, 0.112)) if method == "located" else d, method, factor)

    monkeypatch.setattr(agree, "run", shaken)
    assert kinds(agrees(reference, shaken(d, "located"))) == {"disagrees"}


@pytest.mark.parametrize(("end", "until"), [(0.97, 0.9), (1.0, np.inf)])
def test_a_later_end_is_held_against_a_run_up_to_the_step_that_its_own_end_cuts_short(end, until):
    """Of order two, an impact within is at another time where the step is whole; here it is at t = 0.95."""
    d = Description(
        M=((1.0,),), q0=(0.45125,), v0=(0.0,), t_span=(0.0, end), h=0.1, G=((1.0,),), offset=(0.0,), restitution=0.5,
        constant=(-1.0,),
    )  # fmt: skip
    r, v = run(d, "located"), VARIANTS["end"](d, np.random.default_rng(0))
    other = run(v.scene, "located")
    assert v.until == pytest.approx(until)
    assert kinds(same(base(d, r), other, v)) == set()
    log = np.delete(other.motion.impacts, 0).view(np.recarray)
    other = replace(other, motion=replace(other.motion, impacts=log))
    assert bool(kinds(same(base(d, r), other, v))) is (until == np.inf)


HOPS = Description(
    M=((1.0, 0.0), (0.0, 1.0)), q0=(2.04, -1.28), v0=(0.0, 0.0), t_span=(0.0, 0.0148), h=0.00148,
    G=((0.0, -1.0), (1.0, 0.0)), offset=(-1.28, -2.04), restitution=(1.0, 0.0), K=((47.9, -47.9), (-47.9, 47.9)),
    C=((1.28, -0.295), (-0.295, 1.28)), constant=(0.275, -0.0437), cosine=(1.17, -9.01), sine=(-15.9, 1.51),
    force_omega=15.1, amplitude=(-0.0007, 0.0014), phase=(0.0, 0.0), omega=1.37, general=True, spread=0.0442,
    pendulum=0.638, b=(0.295, -1.36), family="chain",
)  # fmt: skip


@pytest.mark.parametrize(("more", "found"), [(0.0, set()), (2e-5, {"disagrees"})])
def test_damping_of_hops_within_a_step_is_not_asked_of_order_two_and_places_beyond_their_height_are(
    more, found, monkeypatch
):
    """Elastic hops of 14 us and 3 nm in steps of 1.5 ms, on a wall that goes further by `more`."""
    reference = Reference(HOPS, run(HOPS, "event-driven"))
    other = replace(HOPS, amplitude=(-0.0007, 0.0014 + more))
    monkeypatch.setattr(agree, "run", lambda d, *given: run(other if d is HOPS else d, *given))
    assert kinds(agrees(reference, run(other, "located"))) == found


HOPPING = Description(
    M=((1.0,),), q0=(-1.43,), v0=(0.0,), t_span=(0.0, 0.119415), h=0.00229, G=((1.0,),), offset=(1.43,),
    restitution=1.0, constant=(4.17,), cosine=(-3.77,), force_omega=0.899, frame=(-0.241,), omega=22.3,
)  # fmt: skip
FALLING = Description(
    M=((1.0,),), q0=(0.3,), v0=(0.0,), t_span=(0.0, 2.0), h=1e-4, G=((1.0,),), offset=(0.0,), restitution=0.8,
    constant=(-9.81,),
)  # fmt: skip


@pytest.mark.parametrize(("d", "heavier", "found"), [(HOPPING, 1.0, set()), (FALLING, 1.5, {"disagrees"})])
def test_hops_between_two_times_of_a_grid_are_rest_but_no_other_motion_is(d, heavier, found, monkeypatch):
    """A mass on an elastic stop hops 3e-8 m high within a step; one of half as much again falls otherwise."""
    other = replace(d, M=((heavier,),))
    monkeypatch.setattr(agree, "run", lambda x, name, f=1.0: run(other if name == "moreau" else x, name, f))
    assert kinds(agrees(Reference(d, run(d, "event-driven")), run(other, "moreau"))) == found
