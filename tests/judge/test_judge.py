"""The judge sees what is wrong, and only that."""

import os
import signal
from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest

from benchmarks.judge import agree, runs
from benchmarks.judge.agree import disturbed
from benchmarks.judge.case import judged
from benchmarks.judge.checks import check, within_a_step
from benchmarks.judge.describe import Description
from benchmarks.judge.pool import Answer, answers
from benchmarks.judge.report import Tally, report
from benchmarks.judge.runs import Clock, run
from benchmarks.judge.shrink import shrunk
from benchmarks.judge.variants import VARIANTS, Variant, fits, rest
from benchmarks.judge.vary import base, same, varied
from tests.marks import compiled_only

BALL = Description(
    M=((2.0,),), q0=(1.0,), v0=(0.3,), t_span=(0.0, 1.5), h=0.01, G=((1.0,),), offset=(0.0,), restitution=0.5,
    constant=(-19.62,), family="ball",
)  # fmt: skip
CORNER = Description(
    M=((2.0, 0.0), (0.0, 1.0)), q0=(1.0, 0.7), v0=(0.3, 0.1), t_span=(0.0, 1.0), h=0.01, G=((1.0, 0.2), (0.1, 1.0)),
    offset=(0.0, 0.0), restitution=(0.5, 0.3), constant=(-9.0, -9.81), family="corner",
)  # fmt: skip


def kinds(findings):
    return {x.kind for x in findings}


def tampered(method="event-driven", **changes):
    """A run of the ball in which something has been changed."""
    r = run(BALL, method)
    return replace(r, motion=replace(r.motion, **{k: f(getattr(r.motion, k)) for k, f in changes.items()}))


@pytest.mark.parametrize("d", [BALL, CORNER], ids=lambda d: d.family)
def test_nothing_is_found_where_nothing_is_wrong(d):
    verdict = judged(d, ("event-driven", "located", "moreau"), share=1.0)
    assert verdict.findings == []
    assert set(verdict.endings.values()) == {"DONE"}


@pytest.mark.parametrize(
    ("kind", "changes"),
    [
        ("not finite", {"q": lambda q: np.where(q == q[3], np.nan, q)}),
        ("penetration", {"q": lambda q: q - 1e-3}),
        ("negative impulse", {"impulse": lambda p: p - 1e-3 * np.max(p)}),
        ("impulse while open", {"impulse": lambda p: p + 1e-3 * np.max(p)}),
        ("energy gained", {"v": lambda v: v * np.linspace(1.0, 1.1, len(v))[:, None]}),
        ("wrong span", {"t": lambda t: t * 0.9}),
    ],
)
def test_what_is_wrong_with_a_run_is_found(kind, changes):
    assert kind in kinds(check(BALL, tampered(**changes)))


def test_a_depth_that_scatters_with_the_grid_is_no_finding_and_one_beyond_a_step_is():
    slit = Description(
        M=((1.53,),), q0=(0.0,), v0=(0.0,), t_span=(0.0, 10.6), h=0.0418, G=((1.0,), (-1.0,)), offset=(0.0262, 1.79),
        restitution=0.16, K=((0.12,),), C=((0.0192,),), constant=(-2.41,), general=True, family="slit",
    )  # fmt: skip
    r = run(slit, "moreau")
    assert "penetration" not in kinds(check(slit, r))
    assert within_a_step(slit, r, 0.0)
    assert not within_a_step(slit, replace(r, motion=replace(r.motion, q=r.motion.q - 0.012)), 0.0)
    assert "penetration" not in kinds(
        check(slit, replace(r, status="LCP_FAILED"))
    )  # ends early, and no deeper


def test_a_wrong_restitution_is_found(monkeypatch):
    """A method that takes another restitution than the scene's breaks the law, and goes another way."""
    r = run(replace(BALL, restitution=0.6), "located")
    assert "law of impact" in kinds(check(BALL, r))

    def other(d, name, *rest):
        return run(replace(d, restitution=0.6) if name == "located" else d, name, *rest)

    monkeypatch.setattr(agree, "run", other)
    assert kinds(agree.agrees(agree.Reference(BALL, run(BALL, "event-driven")), r)) == {"disagrees"}


def test_variants_of_another_scene_are_found():
    b = base(CORNER, run(CORNER, "event-driven"))
    for make in VARIANTS.values():
        v = make(CORNER, np.random.default_rng(1))
        assert list(same(b, run(v.scene, "event-driven"), v)) == []
        other = run(replace(v.scene, restitution=(0.5, 0.4)), "event-driven")
        assert any("other" in x.kind for x in same(b, other, v)), v.name


@pytest.mark.parametrize("method", ["event-driven", "located", "moreau"])
def test_a_corner_is_the_same_in_other_words(method):
    assert list(varied(CORNER, run(CORNER, method), np.random.default_rng(2), 20)) == []


def test_a_run_begun_anew_on_a_round_joint_and_a_wall_differs_by_rounding():
    """Steps of order two carry the force of the wall over, which depends on velocities: the motion does not."""
    rod = Description(
        M=((1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0)), q0=(1.0, 0.5, 0.2), v0=(0.0, 0.0, 0.0),
        t_span=(0.0, 0.4), h=0.1, G=((0.3, 0.2, 1.0),), offset=(-0.6,), constant=(0.0, -3.0, -9.81),
        J=((0.0, 0.0, 0.0),), joint_offset=(-0.645,), joint_bend=(1.0,), general=True, family="jointed",
    )  # fmt: skip
    assert not fits("rest", rod, "located")
    assert fits("rest", replace(rod, G=(), offset=()), "located")
    true = run(rod, "event-driven").motion.q[-1]
    anew, wrong = [], []
    for h in (0.1, 0.025):
        m = run(replace(rod, h=h), "located").motion
        q, v = m.at(0.2)
        second = replace(rod, h=h, t_span=(0.2, 0.4), q0=tuple(q), v0=tuple(v))
        anew.append(np.max(np.abs(run(second, "located").motion.q[-1] - m.q[-1])))
        wrong.append(np.max(np.abs(m.q[-1] - true)))
    assert max(anew) < 1e-14
    assert 0.0 < wrong[1] < 0.1 * wrong[0]


def test_a_disturbed_scene_keeps_what_is_closed():
    resting = replace(CORNER, q0=(0.0, 0.7), offset=(-0.14, 0.0), v0=(0.0, 0.0))
    near = disturbed(resting, 1e-6, 1.0, 1)
    before, after = (x.scene().gap(0.0, x.q0, x.v0)[0] for x in (resting, near))
    assert after[0] == pytest.approx(0.0, abs=1e-15)
    assert after[1] == pytest.approx(before[1], rel=1e-5)
    assert after[1] != before[1]


# Its mass turns with the place by radians in a step; in a slit, so that no impact takes energy
TURNING = Description(
    M=((1.0, 0.0), (0.0, 1.0)), q0=(0.501, -2.31), v0=(0.0, 0.0), t_span=(0.0, 26.0099), h=0.0511,
    G=((1.0, 0.0), (-1.0, 0.0)), offset=(-0.501, 0.501), restitution=0.078, C=((0.00166, 0.0), (0.0, 0.00166)),
    constant=(2.57, -10.2), general=True, spread=0.361, pendulum=0.115, b=(0.282, 2.0), family="slit",
)  # fmt: skip


@pytest.mark.slow
def test_what_a_run_says_itself_is_not_silent():
    verdict = judged(TURNING, ["located"], share=0.0)
    assert verdict.endings == {"located": "doubt"}
    assert kinds(verdict.findings) == {"said: energy gained"}
    tally = Tally()
    tally.add(Answer(0, TURNING, *verdict))
    lines = report(tally).splitlines()
    assert "| method | runs | DONE | doubt | refused | anomalies in silence | said |" in lines
    assert "| located | 1 | 0 | 1 | 0 | 0 | 1 |" in lines
    assert "| said: energy gained | located | 1 | slit 1 |" in lines


def test_orders_are_seen_before_the_motion_hides_them():
    """A ball that falls on a spring and bounces: order one, two and four."""
    spring = replace(BALL, K=((60.0,),), h=0.02)
    orders = judged(spring, ("event-driven", "located", "located-4", "moreau"), share=0.0).orders
    assert orders["located"] == pytest.approx(2.0, abs=0.2)
    assert orders["located-4"] == pytest.approx(4.0, abs=0.4)
    assert set(orders) == {"located", "located-4", "moreau"}  # that of `Moreau` scatters with the grid
    tally = Tally()
    tally.add(Answer(0, spring, {"located": "DONE"}, [], {"located": 2.0}))
    assert "| located | 1 | 2.00 | 2.00 to 2.00 | 0 |" in report(tally)


ELASTIC = replace(BALL, restitution=1.0, q0=(1e-3,), v0=(0.0,), t_span=(0.0, 900.0))


class Deaf(Description):
    """A scene whose run ends the process, as the system does where machine code does not return."""

    def scene(self):
        os.kill(os.getpid(), signal.SIGVTALRM)


@pytest.mark.slow
def test_a_run_that_is_long_is_no_anomaly():
    (answer,) = answers([(7, replace(ELASTIC, h=1e-5, t_span=(0.0, 100.0)))], ["moreau"], 1, limit=4e-4)
    assert answer.endings == {"moreau": "cut short"}
    assert answer.findings == []


@pytest.mark.slow
def test_a_run_without_end_is_reported_and_the_rest_goes_on():
    (answer,) = answers([(7, Deaf(**vars(BALL)))], ["event-driven"], 1)
    assert answer.index == 7
    assert answer.endings == {"event-driven": "hang"}
    assert kinds(answer.findings) == {"hang"}
    tally = Tally()
    tally.add(answer)
    assert "| hang | event-driven | 1 | ball 1 |" in report(tally)


@compiled_only
def test_a_run_that_does_not_come_on_is_an_anomaly(monkeypatch):
    monkeypatch.setattr(Clock, "limit", 1e-3)
    monkeypatch.setattr(runs, "CPU_EACH", 0.0)
    verdict = judged(replace(ELASTIC, general=True), ["event-driven"])
    assert verdict.endings == {"event-driven": "hang"}
    assert kinds(verdict.findings) == {"hang"}


@pytest.mark.slow
def test_anomalies_are_made_small():
    """What is wrong with this scene is its second contact."""
    small = shrunk(CORNER, lambda d: 1.0 in [row[-1] for row in d.G], seconds=30.0)
    assert (small.contacts, small.constant, small.restitution) == (1, (), 0.0)


def test_rest_between_walls_without_room_begins_anew():
    """A speed of rounding towards a wall, and no room: the law has no answer, and the motion is rest either way."""
    jammed = Description(
        M=((0.00313, 0.0), (0.0, 0.407)), q0=(-0.759, 1.32), v0=(0.0, 0.0), t_span=(0.0, 0.3), h=0.0164,
        G=((-1.0, 1.0), (1.0, 0.0), (-0.0, -1.0)), offset=(-2.079, 0.759, 1.32), restitution=(0.0, 0.015, 0.69),
        constant=(-0.0307, 0.0), function=True, family="beads",
    )  # fmt: skip
    assert run(replace(jammed, v0=(0.0, 1.1e-15)), "located").done
    for speed, taken in ((1.1e-15, 0.0), (1.1e-3, 1.1e-3)):
        q, v = np.array(jammed.q0), np.array([0.0, speed])
        motion = SimpleNamespace(q=q[None], v=v[None], at=lambda t, q=q, v=v: (q, v))
        second = rest(jammed, np.random.default_rng(1), motion).scene
        assert second.v0 == (0.0, taken)
        assert run(second, "located").done


def test_what_is_rounding_is_no_finding():
    """The law of impact at speeds that are the difference of larger ones; a start that a slit stops at once."""
    r = run(CORNER, "located")
    hit = r.motion.impacts.copy()
    hit.before[0], hit.after[0] = -6e-11, hit.after[0] * 0.0 + 6e-11 * CORNER.rates()[hit.contact[0]] - 3e-16
    assert "law of impact" not in kinds(check(CORNER, replace(r, motion=replace(r.motion, impacts=hit[:1]))))
    hit.after[0] -= 1e-12
    assert "law of impact" in kinds(check(CORNER, replace(r, motion=replace(r.motion, impacts=hit[:1]))))
    slit = Description(
        M=((1.0,),), q0=(0.0,), v0=(-0.569,), t_span=(0.0, 0.0474), h=0.0474, G=((1.0,), (-1.0,)), offset=(0.0, 0.0),
        restitution=0.84, K=((2.14,),), constant=(0.109,), general=True, family="slit",
    )  # fmt: skip
    assert check(slit, run(slit, "located")) == []


def test_a_later_end_may_lie_where_there_is_no_way_on():
    """The obstacle closes upon the body after the end of the shorter span."""
    d = Description(
        M=((2.09, 0.133), (0.133, 0.382)), q0=(0.25, 0.0491), v0=(0.0, 0.0), t_span=(0.0, 0.23333), h=0.0135,
        G=((0.576, 0.0804), (-0.117, 0.127)), offset=(-0.1687190992, 0.025640936527832614), restitution=(0.35, 0.24),
        K=((0.0479, -0.0332), (-0.0332, 0.0716)), constant=(0.010344879999999999, -0.00478443999999989),
        amplitude=(-0.0089, 0.0178), phase=(0.0, 4.46), omega=8.49, bend=(0.64, -0.612), round=(0.0, 0.0),
        family="curved",
    )  # fmt: skip
    b = base(d, run(d, "event-driven"))
    later = Variant("another end", replace(d, t_span=(0.0, 0.31433)))
    other = run(later.scene, "event-driven")
    assert not other.done
    assert list(same(b, other, later)) == []
    assert list(same(b, replace(other, motion=None), later)) != []


def test_a_light_bead_at_rest_that_impulses_move_by_rounding_is_pressed():
    beads = Description(
        M=((6.84e-05, 0.0), (0.0, 0.255)), q0=(0.0, 0.0), v0=(0.0, 0.0), t_span=(0.0, 0.4856), h=0.0607,
        G=((-1.0, 1.0), (1.0, 0.0)), offset=(0.0, 0.0), restitution=(1.0, 0.12), constant=(0.0, -2.5), family="beads",
    )  # fmt: skip
    r = run(beads, "moreau")
    q = r.motion.q + 3e-14
    assert "impulse while open" not in kinds(check(beads, replace(r, motion=replace(r.motion, q=q))))
    q = r.motion.q + 1e-9
    assert "impulse while open" in kinds(check(beads, replace(r, motion=replace(r.motion, q=q))))
