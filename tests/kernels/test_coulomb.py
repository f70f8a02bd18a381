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


STANDING = np.array(  # of four contacts, normals first
    [
        [0.2948, -0.1316, -0.1603, 0.0741, 0.0136, -0.0953, -0.0316, -0.0212],
        [-0.1316, 0.2683, 0.1007, -0.0518, 0.0466, 0.1193, 0.0072, -0.169],
        [-0.1603, 0.1007, 0.3025, 0.0496, 0.0161, 0.0585, 0.0861, 0.0105],
        [0.0741, -0.0518, 0.0496, 0.1913, 0.0096, 0.0016, 0.0803, 0.0076],
        [0.0136, 0.0466, 0.0161, 0.0096, 0.106, 0.0301, -0.0088, -0.1252],
        [-0.0953, 0.1193, 0.0585, 0.0016, 0.0301, 0.2386, 0.0526, -0.1344],
        [-0.0316, 0.0072, 0.0861, 0.0803, -0.0088, 0.0526, 0.1851, 0.0624],
        [-0.0212, -0.169, 0.0105, 0.0076, -0.1252, -0.1344, 0.0624, 0.4044],
    ]
)
OF_FOUR = np.array([0.768, 0.149, 0.651, 0.343])


@pytest.mark.parametrize("approach", [1e-3, 1e-8, 9.5e-12, 1e-14])
def test_so_is_one_beside_contacts_that_stick(approach):
    """Moreau's law by its terms: what does not slide keeps within its cone, what does has all of its friction."""
    rate = np.array([0.0, 0.0, -approach, 0.0, 0.0, -7.4e-7, -1e-12, -7.87])
    c = KERNELS.coulomb.ContactProblem(OF_FOUR, True, 8, False)
    for i, value in enumerate(STANDING.flat):
        c.mobility[i] = value
    for i in range(8):
        c.rate[i] = rate[i]
    for i in range(4):
        c.ids[i] = c.carrier[i] = i
    assert KERNELS.coulomb.solve_contacts(c, 4, 4)
    p = np.array([c.impulse[i] for i in range(8)])
    u, size = (
        STANDING @ p + rate,
        np.abs(STANDING) @ np.abs(p) + np.where(np.abs(rate) < 1e-3, np.abs(rate), 0.0),
    )
    assert [c.rate[i] for i in range(8)] == list(rate)
    assert np.all(p[:4] >= 0.0)
    assert np.all(u[:4] >= -1e-9 * size[:4])
    assert p[:4] @ np.abs(u[:4]) < 1e-9 * p[:4] @ size[:4]
    assert np.all(np.abs(p[4:]) <= (1.0 + 1e-9) * OF_FOUR * p[:4])
    slides = np.abs(u[4:]) > 1e-9 * size[4:]
    np.testing.assert_allclose(
        p[4:][slides], (-np.sign(u[4:]) * OF_FOUR * p[:4])[slides], rtol=1e-9, atol=1e-9 * np.max(p[:4])
    )
