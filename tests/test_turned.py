"""Steps in which a pressed obstacle, or a joint, turns by more than a radian: the run says so."""

import numpy as np
import pytest

from lagrangian import Contacts, Joints, LinearSystem, Scene
from lcpstep import Located, simulate


def inside(t, q, v, p, out):
    out[0] = 1.0 - np.sqrt(q[0] * q[0] + q[1] * q[1])


def normal(t, q, v, p, out):
    r = np.sqrt(q[0] * q[0] + q[1] * q[1])
    out[0, 0], out[0, 1] = -q[0] / r, -q[1] / r


def square(t, q, v, p, out):
    out[0] = 0.5 * (q[0] * q[0] + q[1] * q[1] - 1.0)


def radius(t, q, v, p, out):
    out[0, 0], out[0, 1] = q[0], q[1]


def scene(kind, speed, t_end):
    """A particle of 1 kg that is held on a circle of 1 m from within, or by a joint, and turns by speed t."""
    rows = {"contact": {"contacts": Contacts(1, inside, normal)}, "joint": {"joints": Joints(1, square, radius)}}
    start = {"q0": [0.0, -1.0], "v0": [speed, 0.0], "t_span": (0.0, t_end)}
    return Scene(LinearSystem(M=np.eye(2)), **start, **rows[kind])


@pytest.mark.parametrize("kind", ["contact", "joint"])
@pytest.mark.parametrize("method", [Located(0.1)], ids=str)
@pytest.mark.parametrize(("angle", "said"), [(0.3, False), (1.1, True)])
def test_a_circle_that_turns_by_more_than_a_radian_in_a_step_is_told(kind, method, angle, said):
    run = simulate(scene(kind, 10.0 * angle, 2.0), method)
    assert ("radian within a step" in run.doubt) is said
