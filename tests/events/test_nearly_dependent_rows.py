"""Rows held that depend on each other but for little: bodies of unlike masses, and contacts that joints nearly hold.

stack  M g t on the floor, closed form;    bead on a rail of slope e:  the rail presses with f / e
"""

import numpy as np
import pytest

from lagrangian import Coulomb, Harmonic, LinearContacts, LinearJoints, LinearSystem, Scene
from lcpstep import EventDriven, Status, simulate

G = 9.81
OMEGA = 3.0
OVER_TIME = 1.0 + 0.3 * (1.0 - np.cos(OMEGA)) / OMEGA  # of 1 + 0.3 sin(OMEGA t), over a second


def load(constant):
    return Harmonic(constant=constant, sine=0.3 * np.array(constant), omega=OMEGA)


@pytest.mark.parametrize("mu", [None, 0.0, 1e-12, 0.3])
@pytest.mark.parametrize("heavy", [1e3, 1e10, 1e12])
def test_a_light_body_between_heavy_ones_bears_the_upper_one(heavy, mu):
    m = np.array([heavy, 1.0, heavy])
    up, along = np.eye(3) - np.eye(3, k=-1), np.zeros((3, 3))
    friction = None if mu is None else Coulomb(mu, np.hstack([along, up]))
    contacts = LinearContacts(np.hstack([up, along]), friction=friction)
    system = LinearSystem(np.diag(np.tile(m, 2)), force=load([*(-G * m), 0.0, 0.0, 0.0]))
    run = simulate(Scene(system, np.zeros(6), np.zeros(6), (0.0, 1.0), contacts), EventDriven())
    assert run.status is Status.DONE
    np.testing.assert_allclose(run.q[-1], 0.0, rtol=0, atol=1e-12)
    expected = G * np.cumsum(m[::-1])[::-1] * OVER_TIME
    np.testing.assert_allclose(run.impulse.sum(0), expected, rtol=1e-12, atol=0)


@pytest.mark.parametrize("friction", [None, Coulomb(0.3, [[1.0, 0.0]])], ids=["smooth", "rough"])
@pytest.mark.parametrize("slope", [1e-2, 1e-8, 1e-10])
def test_a_bead_lies_where_its_rail_dips_into_a_floor_however_flatly(slope, friction):
    """Pulled down the rail with 3 N: what holds it is the floor, whose row is nearly the rail's."""
    scene = Scene(
        LinearSystem(np.diag([1.0, 2.0]), force=load([-3.0, -5.0])), [0.0, 0.0], [0.0, 0.0], (0.0, 1.0),
        LinearContacts([[0.0, 1.0]], friction=friction), LinearJoints([[-slope, 1.0]]),
    )  # fmt: skip
    run = simulate(scene, EventDriven())
    assert run.status is Status.DONE
    np.testing.assert_allclose(run.q[-1], 0.0, rtol=0, atol=1e-12)
    np.testing.assert_allclose(run.impulse.sum(), (5.0 + 3.0 / slope) * OVER_TIME, rtol=1e-12, atol=0)


def test_what_lies_still_under_a_varying_load_takes_as_few_steps_without_friction_as_with_it():
    """What forces that cancel leave by rounding is no motion, whose periods steps would have to resolve."""
    steps = []
    for friction in (None, Coulomb(0.3, [[0.0, 0.0, 1.0, 0.0], [0.0, 0.0, -1.0, 1.0]])):
        m = np.array([1.0, 100.0])
        contacts = LinearContacts([[1.0, 0.0, 0.0, 0.0], [-1.0, 1.0, 0.0, 0.0]], friction=friction)
        system = LinearSystem(np.diag(np.tile(m, 2)), force=load([*(-G * m), 0.0, 0.0]))
        steps.append(
            simulate(
                Scene(system, np.zeros(4), np.zeros(4), (0.0, 1.0), contacts), EventDriven()
            ).counts.steps
        )
    assert steps[0] == steps[1] < 60
