"""Functions asked between runs: by machine code as by Python, and what a run has noted stays noted."""

import numpy as np
import pytest

from lagrangian import LinearContacts, Scene, System
from lcpstep.callbacks.faults import Fault, fault, forget, note
from lcpstep.callbacks.prepared import evaluate


def mass(t, q, v, p, out):
    out[0, 0], out[0, 1], out[1, 0], out[1, 1] = 2.0 + q[0] ** 2, t, t, 1.0 / p[0]


def force(t, q, v, p, out):
    out[0] = out[1] = v[0]


SCENE = Scene(
    System(2, mass, force), [0.5, 1.0], [0.0, 0.0], (0.0, 1.0), LinearContacts([[1.0, 0.0]]), p=[4.0]
)
AT = 0.3, np.array([0.5, 1.0]), np.zeros(2)


def test_a_function_is_evaluated_with_the_parameters_of_its_scene():
    np.testing.assert_array_equal(evaluate("mass", mass, SCENE, AT, (2, 2)), [[2.25, 0.3], [0.3, 0.25]])


def test_one_that_fails_is_named_and_leaves_what_has_been_noted():
    def fails(t, q, v, p, out):
        out[0] = 1.0 / (q[0] - 0.5) if q[1] < 2.0 else 0.0

    forget()
    for noted in (None, Fault("of the run", 0.1, AT[1], AT[2])):
        if noted is not None:
            note(noted)
        with pytest.raises(ValueError, match=r"^system\.force: f"):
            evaluate("system.force", fails, SCENE, AT, (1,))
        assert fault() is noted
    forget()
