"""Impacts that are left out, being too low for the tolerance, and what they would throw off."""

from __future__ import annotations

import numpy as np
import pytest

from lagrangian import LinearContacts, LinearSystem, Scene
from lcpstep import EventDriven, Kind, simulate

G = np.array([[1.0, 0.0], [0.8, 0.6]])  # an impact of either drives the other off
PRESSED = np.array([1.0, 100.0])  # forces of the two contacts when both are closed


def in_the_corner(speed: float, stiffness: float = 0.0) -> Scene:
    """The first contact rests and is hardly pressed, the second hops low under a strong force."""
    system = LinearSystem(np.eye(2), K=stiffness * np.eye(2), force=tuple(-PRESSED @ G))
    contacts = LinearContacts(G, restitution=(0.0, 0.05))
    v0 = np.linalg.solve(G, [0.0, speed])
    return Scene(system, q0=(0.0, 0.0), v0=tuple(v0), t_span=(0.0, 0.2), contacts=contacts)


@pytest.mark.parametrize("tolerance", [1e-4, 1e-6])
@pytest.mark.parametrize("speed", [0.01, 0.02, 0.03])
@pytest.mark.parametrize("stiffness", [0.0, 1.0])  # by parabolas, and by steps
def test_a_low_hop_is_followed_where_its_impact_throws_another_contact_off(speed, tolerance, stiffness):
    scene, times = in_the_corner(speed, stiffness), np.linspace(0.0, 0.2, 100)
    exact = simulate(scene, EventDriven(1e-13, 1e-13)).at(times)[0]
    loose = simulate(scene, EventDriven(tolerance, tolerance)).at(times)[0]
    assert np.max(np.abs(loose - exact)) <= 2.0 * tolerance


def test_what_is_thrown_off_rises_as_high_as_newtons_law_says():
    u = 0.03
    log = simulate(in_the_corner(u), EventDriven(1e-6, 1e-6)).impacts
    thrown = log[(log.kind == Kind.RELEASE) & (log.contact == 0)][0]
    # one impact of the second contact, from -u to 0.05 u, or the whole sequence that takes u
    assert 1.0 <= thrown.after / (u * (G @ G.T)[0, 1]) <= 1.05 * (1.0 + 1e-9)
