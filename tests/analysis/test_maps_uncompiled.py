"""The kernels of maps as plain Python: the same answers as built, to the last bit."""

import pytest

from tests.uncompiled import both_ways

PROGRAM = """
from dataclasses import fields
from hashlib import sha256
import numpy as np
from lagrangian import scenes
from lcpstep import EventDriven, Moreau
from lcpstep.maps import periods
from lcpstep.maps.batch import Targets
scene = scenes.cam_follower(rpm=137.0, coordinates="absolute")
x = np.stack([np.linspace(0.5, 1.2, 5), np.linspace(-5.0, 9.0, 5)], axis=1)
targets = Targets(np.array([[0.5, 1.0], [0.4, 0.0]]), np.array([0.1, 0.3]), np.array([1.0, 10.0]))
found = periods(scene, {method}, x, {n}, drop={n} - 2, tangents={tangents}, targets={targets}, strict=False)
parts = [np.ascontiguousarray(getattr(found, field.name)).tobytes() for field in fields(found)]
print(int(found.impacts.sum()), sha256(b"".join(parts)).hexdigest())
"""
WAYS = {
    "event-driven, with derivatives": ("EventDriven()", 12, True, None),
    "event-driven, to a target": ("EventDriven()", 12, False, "targets"),
    "in lockstep": ("Moreau(2e-3)", 3, True, None),
}


@pytest.mark.parametrize("way", WAYS)
def test_periods_are_the_same_uncompiled(tmp_path, way):
    program = PROGRAM
    for name, value in zip(("method", "n", "tangents", "targets"), WAYS[way], strict=True):
        program = program.replace("{" + name + "}", str(value))
    built, plain = both_ways(tmp_path, program)
    assert built == plain
