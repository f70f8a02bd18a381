"""Random scenes before the judge, and those that have been wrong once.

What is still open is listed by class, so that nothing new comes in beside it; the list only gets shorter, and
docs/accuracy.md says how often each happens.
"""

from dataclasses import replace
from itertools import count, islice

import numpy as np
import pytest

from benchmarks.judge import physics
from benchmarks.judge.case import judged
from benchmarks.judge.checks import within_a_step
from benchmarks.judge.draw import draw
from benchmarks.judge.pool import answers
from benchmarks.judge.runs import WAYS, run, silent
from lcpstep import EventDriven, Located, Status, simulate
from lcpstep.trajectory import Kind
from tests.judge.kept import KEPT
from tests.judge.kept_jointed import JOINTED
from tests.judge.kept_lately import LATELY
from tests.judge.kept_loose import LOOSE
from tests.judge.kept_other import OTHER
from tests.judge.kept_recently import RECENTLY
from tests.judge.open import OPEN
from tests.marks import COMPILES, shared, slow

QUICK = ("event-driven", "located", "moreau")


def new(findings):
    """Findings whose class is not known, in runs that have not said that they are wrong."""
    return [x for x in findings if silent(x.kind) and x.kind not in OPEN.get(x.method, ())]


LONG = {  # of those that the quick tests have
    "an elastic and a plastic wall that bring five masses on a sphere to rest on them",
    "forty elastic impacts in a step",
    "a span in two parts, an elastic contact at rest where the second begins",
    "a joint that hands the energy of a heavy body to light ones within a millisecond",
    "contacts beside a joint, pressed by forces that begin at zero",
    "bowl, short",
    "a bowl that shrinks around a body in its middle",
    "chattering on a table",
    "a light mass on a rod that the heavy one lets go through a dead point",
    "wedge of three walls",
    "a curved joint turns a gap",
    "a heavy body squeezes light ones against a wall",
    "a body that three walls hold on a curved joint",
    "four feet of different restitution",
    "a debt of a contact that bears no force any more",
    "an elastic wall beside two that yield, which bring five masses on a sphere to rest on them",
    "contacts beside a bent joint, masses over six decades",
    "five masses from half a gram to nine tonnes on a sphere, long before time zero",
    "a light mass whirled round a joint in a few steps",
    "gaps that drift from the state over thousands of impacts",
}
KNOWN = KEPT | LATELY | RECENTLY | JOINTED | LOOSE | OTHER
LONGEST = {
    "ends of chattering that thousands of impacts interrupt",
    "low hops of a body in a shaken wedge a day before time zero",
    "a joint and a contact whose normals become parallel",
    "beads at rest on each other between walls that set out",
    "four feet on two tables and the ground, an hour before time zero",
}
NAMES = slow(KNOWN, *LONG, *RECENTLY, *LOOSE, *OTHER, longest=LONGEST)


@pytest.mark.parametrize("name", NAMES)
def test_what_was_wrong_once_is_right(name):
    d, methods = KNOWN[name]
    found = judged(d, methods, share=1.0).findings
    assert [x for x in found if COMPILES or x.kind != "slow"] == []


def test_a_force_that_begins_at_zero_lets_go_once():
    """Of so short steps, at its beginning, nothing but rounding would bring the contact back."""
    motion = run(KEPT["touched at the very beginning of a step"][0], "located-4-tolerance").motion
    assert motion.status == Status.DONE
    assert len(motion.impacts) < 10


@pytest.mark.parametrize("method", ["located-4", "located-4-tolerance"])
def test_walls_between_which_rounding_is_the_only_force_keep_a_body_at_rest(method):
    """Nearly opposite normals make a large force of it, which has no sign to let go by."""
    d = RECENTLY["at rest without forces between two walls that enclose three degrees"][0]
    motion = run(d, method).motion
    assert motion.status == Status.DONE
    assert np.max(np.abs(motion.q - np.array(d.q0))) < 1e-14


def test_a_contact_that_opens_at_the_start_does_not_open_before_it():
    """Far from time zero a step's end less its length is not its beginning."""
    d = LATELY["a contact that the forces at the start press with nothing to rounding"][0]
    later = replace(
        d, t_span=(64.0, 64.7524), cosine=(1.7083070670967344, -27.44298454261806, 1.0650492749796037),
        sine=(3.1019166598262036, -6.780309682722908, 4.450367405267279),
    )  # fmt: skip
    log = run(later, "located").motion.impacts
    assert list(log.kind) == [Kind.RELEASE]
    assert log.time[0] == 64.0


def test_walls_that_close_upon_a_body_end_every_run():
    """By their own equations alone: when nothing is left between them, and how deep half a step then is."""
    d = RECENTLY["a mass in a slit that its walls close, struck by each of them before"][0]
    times = np.linspace(0.05, 1.7, 33_001)
    closed = times[physics.gaps(d, times, np.zeros((len(times), 1))).sum(axis=1) < 0.0][0]
    for h in (d.h, d.h / 4.0, d.h / 16.0):
        r = run(replace(d, h=h), "moreau")
        assert r.status == "LCP_FAILED"
        assert "nothing left between" in r.text
        assert abs(r.motion.t[-1] - closed) < 2.0 * h
        assert within_a_step(replace(d, h=h), r, 0.0)
    exact = run(d, "located-exact")
    assert exact.motion.t[-1] == pytest.approx(closed, abs=5e-5)


@pytest.mark.parametrize("tolerance", [1e-5, 1e-6, 1e-8, 1e-9])
def test_walls_that_squeeze_a_body_out_end_a_run_at_one_time(tolerance):
    """Its gaps stay closed up to there, and its speed has grown beyond all that springs could give."""
    d = LOOSE["a body squeezed out between two walls that become parallel"][0]
    m = simulate(d.scene(), EventDriven(tolerance, tolerance))
    assert m.status == Status.LCP_FAILED
    assert "closed contacts [0, 2]" in m.message
    assert m.t[-1] == pytest.approx(0.00568476824870, rel=1e-11)  # of 1e-13, by ever shorter steps
    normals = physics.jacobians(d, m.q[-1])[[0, 2]]
    assert abs(np.linalg.det(normals)) < 1e-6 * np.prod(np.linalg.norm(normals, axis=1))


@pytest.mark.parametrize("tolerance", slow([1e-4, 1e-6, 1e-8, 1e-10, 1e-12], 1e-8, longest=[1e-6, 1e-10]))
def test_a_motion_of_which_nothing_is_left_is_at_rest(tolerance):
    """Its impacts had no impulses where numbers end, at 1e-308; by steps it dies away as far."""
    scene = LOOSE["a corner of four walls in which nothing is left of a motion"][0].scene()
    m = simulate(scene, EventDriven(tolerance, tolerance))
    assert m.status == Status.DONE
    assert abs(m.q[-1]).max() == abs(m.v[-1]).max() == 0.0
    assert abs(simulate(scene, Located(scene.t_span[1] / 50_000, order=4)).v[-1]).max() < 1e-90 * tolerance


def test_hops_that_others_interrupt_end():
    """They had gone on for ever, at 1e-8 m/s, from gaps that rounding had made larger."""
    d = RECENTLY["a body thrown into a corner of three walls, one of them elastic"][0]
    motion = run(d, "event-driven").motion
    assert motion.status == Status.DONE
    assert abs(motion.v[-1]).max() < 1e-40
    speeds = motion.impacts.after[(motion.impacts.contact == 1) & (motion.impacts.kind == Kind.IMPACT)]
    assert speeds[-1] < 1e-10


@pytest.mark.slow
def test_elastic_hops_beside_what_yields_fade_as_between_events():
    """Each brings six parts in seven of its speed to the next, down to the tolerance, and then there are no more."""
    d = JOINTED["an elastic and a plastic wall that bring five masses on a sphere to rest on them"][0]
    speeds = []
    for method in ("located-4", "event-driven"):
        motion = run(d, method).motion
        log = motion.impacts
        there = (log.contact == 1) & (log.kind == Kind.IMPACT) & (log.time > 5.59) & (log.time < 5.6)
        speeds.append(log.before[there])
        assert motion.status == Status.DONE
    assert len(speeds[0]) == len(speeds[1]) > 100
    assert np.allclose(*speeds, rtol=5e-3, atol=0.0)


@pytest.mark.parametrize("tolerance", [None, 1e-7])
def test_a_body_on_a_rod_leaves_by_a_force_that_begins_at_zero(tolerance):
    """Against its closed form; what its wall does not touch takes as few steps as a motion without it."""
    d = JOINTED["a body on a rod that forces which begin at zero take off a wall"][0]
    J, inverse = np.array(d.J[0]), 1.0 / np.diag(np.array(d.M))
    a = inverse * (d.constant - J * (J @ (inverse * d.constant)) / (J @ (inverse * J)))
    motion = simulate(d.scene(), Located(d.h, 4, tolerance=tolerance))
    t, w = motion.t[:, None], d.force_omega
    assert motion.status == Status.DONE
    assert np.max(np.abs(motion.q - a * (0.5 * t**2 - (1.0 - np.cos(w * t)) / w**2))) < 2e-9
    assert len(motion.impacts) < 3
    assert motion.counts.steps < 1.2 * d.length / d.h


@pytest.mark.parametrize(("tolerance", "most"), [(None, 1000), (1e-7, 5000)])
def test_one_of_two_walls_lets_go_by_forces_that_begin_at_zero(tolerance, most):
    """The springs bring higher powers of time in, which a polynomial of degree five does not have."""
    d = JOINTED["a body on a rod and springs, of whose two walls one lets go by forces that begin at zero"][0]
    motion = simulate(d.scene(), Located(d.h, 4, tolerance=tolerance))
    exact = simulate(d.scene(), EventDriven())
    assert motion.status == exact.status == Status.DONE
    assert np.max(np.abs(motion.q[-1] - exact.q[-1])) < 1e-6
    assert motion.counts.force_evaluations < most


def judge(numbers, seed, methods, share):
    """Findings of new classes, each with its scene."""
    scenes = ((k, draw(seed, k)) for k in numbers)
    for answer in answers(scenes, list(methods), workers=1, share=share):
        yield from [(answer.index, answer.scene, x) for x in new(answer.findings)]


def short(seed, scenes, contacts=100):
    """Numbers of the first scenes whose runs take less than a hundred steps."""
    numbers = (k for k in count() if (d := draw(seed, k)).length < 100.0 * d.h and d.contacts < contacts)
    return list(islice(numbers, scenes))


def test_ten_scenes():
    """Short ones, by the methods that are asked for most, in this process."""
    scenes = [draw(3, k) for k in short(3, 10, contacts=5)]
    assert [(d, found) for d in scenes for found in new(judged(d, QUICK, share=0.02).findings)] == []


@pytest.mark.thorough
def test_some_hundred_scenes():
    assert list(judge(short(3, 200, contacts=5)[10:], 3, QUICK, 0.02)) == []


GRAVE = {"hang", "not finite", "penetration", "raised", "tolerance missed", "finer tolerance missed"}


@pytest.mark.parametrize("first", shared(range(0, 300, 12), 25))
def test_some_hundred_scenes_by_every_method(first):
    """None hangs, leaves the finite numbers, goes through a wall or misses its tolerance by more than ten times."""
    found = judge(short(221122, first + 12)[first:], 221122, tuple(WAYS), 0.0)
    assert [x for x in found if x[2].kind in GRAVE] == []
