"""Steps in which a pressed obstacle, or a joint, turns by more than a radian: the run says so."""

import math
import re

import numpy as np
import pytest

from benchmarks.judge.describe import Description
from lagrangian import Contacts, Joints, LinearSystem, Scene, System
from lcpstep import EventDriven, Located, Moreau, simulate
from lcpstep.cli.common import DONE, FAILED
from lcpstep.doubts.turned import turned
from lcpstep.kernels.turned import farthest_turn
from lcpstep.model import joints_looked_at, looked_at
from lcpstep.trajectory import Status
from tests.commands import run as command
from tests.uncompiled import both_ways


def inside(t, q, v, p, out):
    out[0] = 1.0 - np.sqrt(q[0] * q[0] + q[1] * q[1])


def normal(t, q, v, p, out):
    r = np.sqrt(q[0] * q[0] + q[1] * q[1])
    out[0, 0], out[0, 1] = -q[0] / r, -q[1] / r


def square(t, q, v, p, out):
    out[0] = 0.5 * (q[0] * q[0] + q[1] * q[1] - 1.0)


def radius(t, q, v, p, out):
    out[0, 0], out[0, 1] = q[0], q[1]


ROWS = {"contact": {"contacts": Contacts(1, inside, normal)}, "joint": {"joints": Joints(1, square, radius)}}


def scene(kind, speed, t_end):
    """A particle of 1 kg that is held on a circle of 1 m from within, or by a joint, and turns by speed t."""
    start = {"q0": [0.0, -1.0], "v0": [speed, 0.0], "t_span": (0.0, t_end)}
    return Scene(LinearSystem(M=np.eye(2)), **start, **ROWS[kind])


METHODS = {
    "contact": [Located(0.1)],
    "joint": [Located(0.1, 4), Moreau(0.1)],
}
CASES = [(kind, method) for kind, methods in METHODS.items() for method in methods]


@pytest.mark.parametrize(("kind", "method"), CASES, ids=lambda x: str(x)[:7])
@pytest.mark.parametrize(("angle", "told"), [(0.3, False), (0.9, False), (1.12, True)])
def test_a_circle_that_turns_by_more_than_a_radian_in_a_step_is_told(kind, method, angle, told):
    run = simulate(scene(kind, 10.0 * angle, 0.5 if kind == "contact" else 0.2), method)
    assert run.status is Status.DONE
    assert ("turns by" in run.doubt) is ("turns by" in run.message) is told
    if told:
        named, far, t = re.match(
            r"(.*) turns by (\S+) radian within a step at t = (\S+) s", run.doubt
        ).groups()
        k = int(np.argmin(np.abs(run.t - float(t))))
        one, other = run.q[k] / np.linalg.norm(run.q[k]), run.q[k + 1] / np.linalg.norm(run.q[k + 1])
        assert named == ("joint 0" if kind == "joint" else "the obstacle of contact 0")
        assert float(far) == pytest.approx(math.acos(one @ other), rel=1e-2)
        assert float(far) > 1.0


SCENE = """
from lagrangian import Joints, LinearSystem, Scene


def square(t, q, v, p, out):
    out[0] = 0.5 * (q[0] * q[0] + q[1] * q[1] - 1.0)


def radius(t, q, v, p, out):
    out[0, 0], out[0, 1] = q[0], q[1]


def scene(speed=3.0):
    system = LinearSystem(M=[[1.0, 0.0], [0.0, 1.0]])
    return Scene(system, [0.0, -1.0], [speed, 0.0], (0.0, 0.2), joints=Joints(1, square, radius))
"""


@pytest.mark.parametrize(("speed", "status"), [("3", DONE), ("11.2", FAILED)])
def test_the_command_ends_with_a_status_of_its_own(folder, capsys, speed, status):
    (folder / "mine.py").write_text(SCENE)
    asked = (
        "simulate",
        "mine.py",
        "--set",
        f"speed={speed}",
        "--method",
        "located",
        "--h",
        "0.1",
        "--order",
        "4",
    )
    ended, out, err = command(capsys, *asked)
    assert (ended, "turns by" in out + err) == (status, status == FAILED)


def test_steps_by_a_tolerance_and_events_are_not_asked():
    s = scene("contact", 11.2, 0.5)
    for method in (Located(0.1, tolerance=1e-3), EventDriven()):
        assert simulate(s, method).doubt == ""


@pytest.mark.parametrize("method", [Located(2.5), Located(2.5, order=4)], ids=repr)
@pytest.mark.parametrize("angle", [1.1, 2.0, 2.8])
def test_what_flies_from_impact_to_impact_is_not_held_however_far_apart_the_normals_are(method, angle):
    """A billiard in a circle: chords of one length, each turned by the same angle; no step is too long for a line."""
    chord = 2.0 * math.sin(0.5 * angle)
    start = {
        "q0": [1.0 - 1e-9, 0.0],
        "v0": [-math.sin(0.5 * angle), math.cos(0.5 * angle)],
        "t_span": (0.0, 30.0),
    }
    run = simulate(
        Scene(LinearSystem(M=np.eye(2)), contacts=Contacts(1, inside, normal, restitution=1.0), **start),
        method,
    )
    k = np.arange(1, len(run.impacts) + 1)
    assert len(k) == int(30.0 / chord)
    assert np.allclose(run.impacts.time, k * chord, atol=1e-6)
    assert run.doubt == ""


def test_what_only_touches_the_obstacle_may_turn():
    """Thrown across the circle it is pressed at one end of a step alone; each impact throws it back."""
    s = Scene(
        LinearSystem(M=np.eye(2)),
        [0.0, -0.3],
        [11.0, 0.3],
        (0.0, 1.0),
        Contacts(1, inside, normal, restitution=0.9),
    )
    run = simulate(s, Located(0.1))
    assert np.min(run.q[:-1, 0] * run.q[1:, 0]) < 0.0  # from one side to the other in a step
    assert run.doubt == ""


def heavier(t, q, v, p, out):
    out[0, 0], out[0, 1], out[1, 0], out[1, 1] = 2.0 + q[0], 0.5, 0.5, 1.0


def nothing(t, q, v, p, out):
    out[0] = out[1] = 0.0


@pytest.mark.parametrize(
    "system", [LinearSystem(M=[[2.0, 0.5], [0.5, 1.0]]), System(2, heavier, nothing)], ids=["M", "M(q)"]
)
def test_the_angle_is_that_in_the_metric_of_the_masses(system):
    """The fastest of each part of the steps that are no longer than is told, and are pressed at both ends."""
    s = Scene(system, [0.0, -1.0], [1.0, 0.0], (0.0, 1.0), **ROWS["contact"])
    rng = np.random.default_rng(5)
    n = 40
    t = np.cumsum(rng.choice([0.1, 0.2], n, p=[0.8, 0.2]))
    q, v = rng.uniform(0.1, 1.0, (n, 2)), rng.uniform(-1.0, 1.0, (n, 2))
    impulse = rng.choice([0.0, 1.0], (n, 1), p=[0.2, 0.8])
    for held, parts in ((None, 4), (impulse, 4), (impulse, 64)):
        best = 1.0, 0
        for i in range(parts):
            steps = [
                k for k in range(i * (n - 1) // parts, (i + 1) * (n - 1) // parts)
                if t[k + 1] - t[k] < 0.15 and (held is None or held[k, 0] * held[k + 1, 0] > 0.0)
            ]  # fmt: skip
            if steps:
                k = max(steps, key=lambda k: v[k] @ v[k] + v[k + 1] @ v[k + 1])
                M = np.array([[2.0 + (q[k, 0] if isinstance(system, System) else 0.0), 0.5], [0.5, 1.0]])
                one, other = q[k] / np.linalg.norm(q[k]), q[k + 1] / np.linalg.norm(q[k + 1])
                W = [x @ np.linalg.solve(M, y) for x, y in ((one, other), (one, one), (other, other))]
                best = min(best, (W[0] / math.sqrt(W[1] * W[2]), k))
        cosine, k, c = farthest_turn(looked_at(s), t, q, v, held, held, 0.15, parts)
        assert (cosine, k, c) == (pytest.approx(best[0], rel=1e-12), best[1], 0)


def test_joints_are_looked_at_with_the_run_s_own_model():
    s = scene("joint", 3.0, 0.2)
    simulate(s, Located(0.01))
    first = joints_looked_at(s)
    assert joints_looked_at(s) is first
    assert joints_looked_at(scene("joint", 3.0, 0.2)) is not first


PROGRAM = """
from dataclasses import replace

from lagrangian import Joints, scenes
from lcpstep import Located, simulate
from lcpstep.cli.common import DONE, FAILED
from lcpstep.kernels.turned import farthest_turn
from lcpstep.model import joint_model, model

def square(t, q, v, p, out):
    out[0] = q[0] * q[0] + q[1] * q[1] - 1.0

def radius(t, q, v, p, out):
    out[0, 0], out[0, 1] = 2.0 * q[0], 2.0 * q[1]

scene = scenes.CATALOGUE["bowl"].make()
run = simulate(replace(scene, t_span=(0.0, 1.0)), Located(0.02))
rows = joint_model(replace(scene, joints=Joints(1, square, radius), q0=[0.6, 0.8], v0=[-0.8, 0.6]))
for parts in (1, 3, 64):
    held = run.impulse, run.impulse, 0.021, parts
    print(*(float(x).hex() for x in farthest_turn(model(scene), run.t, run.q, run.v, *held)))
    print(*(float(x).hex() for x in farthest_turn(rows, run.t, run.q, run.v, None, None, 0.021, parts)))
"""


@pytest.mark.slow
def test_uncompiled_looks_at_what_turns_say_the_same():
    built, plain = both_ways(PROGRAM)
    assert built == plain
    assert len(built) == 6


LIGHT = Description(
    M=((1.71, 0.0, 0.0), (0.0, 0.1, 0.0), (0.0, 0.0, 12400.0)), q0=(-1.06, 0.52, 0.727), v0=(-1.78, 0.775, -4.08),
    t_span=(0.0, 0.4263), h=0.0147, G=((-0.0, -0.0, 0.0), (0.0, -0.0, 0.0)), offset=(1.797564615, 1.2616409491911713),
    restitution=(0.094, 0.37), C=((0.0522, 0.0, 0.0), (0.0, 0.00305, 0.0), (0.0, 0.0, 377.0)),
    constant=(0.0, 0.0, -122000.0), bend=(-1.87, -0.738), round=(0.0, 1.0), general=True, pendulum=0.222,
    b=(0.156, -1.77, -0.608), family='curved',
)  # fmt: skip


@pytest.mark.parametrize("method", [Located(LIGHT.h), Moreau(LIGHT.h)], ids=["located", "moreau"])
def test_light_bodies_under_a_heavy_one_in_bent_obstacles_are_told(method):
    """Twelve tons push 0.1 kg about: off by a third of the motion, outside of all walls again at the end."""
    run, true = simulate(LIGHT.scene(), method), simulate(LIGHT.scene(), EventDriven())
    assert run.status is true.status is Status.DONE
    assert np.max(np.abs(run.q[-1] - true.q[-1])) > 0.3 * np.max(np.ptp(true.q, axis=0))
    assert run.doubt != ""
    assert "radian within a step" in turned(run)
