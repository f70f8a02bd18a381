"""Contacts in any order: the numbers that they have are no part of the question."""

from dataclasses import replace
from itertools import permutations

import numpy as np
import pytest

from benchmarks.judge.describe import Description
from benchmarks.judge.runs import run

# Thrown off together by an elastic wall, two plastic ones are met again one after the other, at 0.85 of the speeds
INTO_A_CORNER = Description(
    M=((0.889, 0.228, 0.253), (0.228, 1.41, 0.319), (0.253, 0.319, 1.74)), q0=(0.0, 0.0, 0.0),
    v0=(0.042089197239613185, -0.008110598907803175, -0.011619812416507239), t_span=(0.0, 1.2), h=0.0382,
    G=((-0.0564, -0.903, 0.426), (0.289, 0.143, 0.947), (-0.777, 0.516, 0.36)), offset=(0.0, 0.0, 0.426),
    restitution=(0.0, 1.0, 0.0), K=((0.0683, -0.0112, 0.0835), (-0.0112, 0.117, 0.0953), (0.0835, 0.0953, 0.281)),
    constant=(0.0, 0.0, -17.1), general=True, family="wedge",
)  # fmt: skip


@pytest.mark.parametrize("order", list(permutations(range(3))))
@pytest.mark.parametrize("method", ["located", "located-4", "located-tolerance"])
def test_a_body_comes_to_rest_in_a_corner_whatever_the_numbers_of_its_walls(method, order):
    rows = {
        name: tuple(getattr(INTO_A_CORNER, name)[i] for i in order) for name in ("G", "offset", "restitution")
    }
    r = run(replace(INTO_A_CORNER, **rows), method)
    assert r.done, r.text
    np.testing.assert_allclose(r.motion.v[-1], 0.0, atol=1e-14)
