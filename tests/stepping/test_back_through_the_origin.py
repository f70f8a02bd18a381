"""A gap stays closed where its coordinates return to zero: they are rounded as they were where they were largest."""

import math

import numpy as np
import pytest

from lagrangian import Coulomb, LinearContacts, LinearSystem, Scene
from lcpstep import Moreau, simulate

G, MU, UP, H = 9.81, 0.1, 3.0, 1e-3


@pytest.mark.parametrize("seed", [2, 32, 7])
def test_an_elastic_body_slides_up_and_down_its_slope_without_a_hop(seed):
    """It lifted off by 5e-16 m as it came back to where it had been thrown from, and hopped for half of the time."""
    angle = np.random.default_rng(seed).uniform(0.2, 1.2)
    along = np.array([math.cos(angle), math.sin(angle)])
    floor = LinearContacts([[-along[1], along[0]]], restitution=1.0, friction=Coulomb(MU, [along]))
    scene = Scene(LinearSystem(np.eye(2), force=[0.0, -G]), np.zeros(2), UP * along, (0.0, 2.0), floor)
    run = simulate(scene, Moreau(H))
    np.testing.assert_allclose(run.impulse[1:, 0], H * G * math.cos(angle), rtol=1e-9)
    rise, fall = (G * (math.sin(angle) + sign * MU * math.cos(angle)) for sign in (1.0, -1.0))
    down = 2.0 - UP / rise
    assert run.q[-1] @ along == pytest.approx(0.5 * UP**2 / rise - 0.5 * fall * down**2, abs=5.0 * H)
