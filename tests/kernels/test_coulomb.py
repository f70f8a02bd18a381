"""Impulses of contacts with friction: two feet of one body, of which one touches down while both slide."""

import numpy as np
import pytest

from tests import uncompiled

KERNELS = uncompiled.kernels("lcpstep.kernels")
MU = np.array([0.054330232682934194, 0.05850925287260167])
# Normals, then tangents, which are one direction
W = np.array(
    [
        [1.9, 0.1, 1.2407200661442666, 1.2407200661442666],
        [0.1, 1.9, -1.2407200661442666, -1.2407200661442666],
        [1.2407200661442666, -1.2407200661442666, 2.710429202814481, 2.710429202814481],
        [1.2407200661442666, -1.2407200661442666, 2.710429202814481, 2.710429202814481],
    ]
)


@pytest.mark.parametrize("approach", [1e-3, 1e-10, 1.4768674435181098e-12, 1e-13, 1e-15])
@pytest.mark.parametrize("sliding", [-0.36862373903055934, 0.36862373903055934])
def test_an_approach_far_slower_than_the_sliding_is_ended(approach, sliding):
    c = KERNELS.coulomb.ContactProblem(MU, True, 4, False)
    for i, value in enumerate(W.flat):
        c.mobility[i] = value
    for i, value in enumerate([-approach, 0.0, sliding, sliding]):
        c.rate[i] = value
    for i in range(2):
        c.ids[i] = c.carrier[i] = i
    assert KERNELS.coulomb.solve_contacts(c, 2, 2)
    impulse = np.array([c.impulse[i] for i in range(4)])
    rates = W @ impulse + [-approach, 0.0, sliding, sliding]
    assert np.all(impulse[:2] >= 0.0)
    assert np.all(rates[:2] >= -1e-9 * approach)
    assert abs(impulse[:2] @ rates[:2]) < 1e-9 * approach * np.sum(impulse[:2])
    assert impulse[2:] == pytest.approx(-np.sign(sliding) * MU * impulse[:2])
