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
for method, n, tangents, aims in (
    (EventDriven(), 6, True, None), (EventDriven(), 6, False, targets), (Moreau(2e-3), 3, True, None),
):
    found = periods(scene, method, x, n, drop=n - 2, tangents=tangents, targets=aims, strict=False)
    parts = [np.ascontiguousarray(getattr(found, field.name)).tobytes() for field in fields(found)]
    print(int(found.impacts.sum()), sha256(b"".join(parts)).hexdigest())
from lcpstep.analysis.variation import monodromy
block = scenes.coulomb_oscillator()
D = monodromy(block, EventDriven(), np.concatenate([block.q0, block.v0]), (0.0, 3.0))
print(D.tolist())
"""
WAYS = [
    "event-driven, with derivatives",
    "event-driven, to a target",
    "in lockstep",
    "with friction, along its events",
]


@pytest.fixture(scope="module")
def lines():
    """What is printed where the library is built, and where it is not: a line for each way."""
    return both_ways(PROGRAM)


@pytest.mark.slow
@pytest.mark.parametrize("way", WAYS)
def test_periods_are_the_same_uncompiled(lines, way):
    built, plain = lines
    assert len(built) == len(plain) == len(WAYS)
    assert built[WAYS.index(way)] == plain[WAYS.index(way)]
