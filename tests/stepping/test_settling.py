"""Mechanisms that settle: what is left of a velocity near rest is rounding, and no reason to give up."""

import math

import numpy as np
import pytest

from lagrangian import Contacts, LinearContacts, LinearSystem, Scene, System
from lagrangian.friction import Coulomb
from lcpstep import Moreau, simulate

HALF, GRAVITY = 0.4, 9.81


def weight(t, q, v, p, out):
    out[0], out[1], out[2] = 0.0, -GRAVITY, 0.0


def ends(t, q, v, p, out):
    out[0], out[1] = q[1] - HALF * math.sin(q[2]), q[1] + HALF * math.sin(q[2])


def normals(t, q, v, p, out):
    c = HALF * math.cos(q[2])
    out[0, 0], out[0, 1], out[0, 2] = 0.0, 1.0, -c
    out[1, 0], out[1, 1], out[1, 2] = 0.0, 1.0, c


def tangents(t, q, v, p, out):
    s = HALF * math.sin(q[2])
    out[0, 0], out[0, 1], out[0, 2] = 1.0, 0.0, s
    out[1, 0], out[1, 1], out[1, 2] = 1.0, 0.0, -s


@pytest.mark.parametrize("friction", [None, Coulomb(0.6, tangents)])
def test_a_rod_that_falls_on_both_ends_comes_to_rest(friction):
    rng = np.random.default_rng(8)
    for restitution in (0.0, 0.3, 0.5):
        angle = rng.uniform(-0.4, 0.4)
        scene = Scene(
            System(3, np.diag([1.0, 1.0, HALF**2 / 3.0]), weight),
            q0=[0.0, HALF * abs(math.sin(angle)) + 0.1, angle],
            v0=rng.normal(size=3) * [1.0, 0.5, 1.0],
            t_span=(0.0, 2.0),
            contacts=Contacts(2, ends, normals, restitution=restitution, friction=friction),
        )
        run = simulate(scene, Moreau(1e-3))
        assert run.message == "reached the end of the span"
        assert np.abs(run.v[-1, 1:]).max() < 1e-6
        assert np.abs(run.q[-1, 1:]).max() < 5e-3  # what it falls in a step


@pytest.mark.parametrize("h", [1e-2, 1e-3])
def test_by_any_law_a_body_that_does_not_slide_bounces_as_by_newtons_and_comes_to_rest(h):
    """By Stronge's it had gone on bouncing, thrown up by what the forces of each step had made it fall."""
    motions = []
    for law in ("newton", "stronge"):
        floor = LinearContacts([[0.0, 1.0]], restitution=0.8, friction=Coulomb(0.3, [[1.0, 0.0]], law=law))
        ball = Scene(LinearSystem(np.eye(2), force=[0.0, -9.81]), [0.0, 0.1], [0.0, 0.0], (0.0, 2.0), floor)
        motions.append(simulate(ball, Moreau(h)))
    by_newton, by_stronge = motions
    fast = by_newton.t < 1.0  # slower ones end sooner by the one than by the other
    np.testing.assert_allclose(by_stronge.q[fast], by_newton.q[fast], rtol=0, atol=1e-12)
    fall = (2.0 * 0.1 / 9.81) ** 0.5
    assert by_stronge.impacts.time[-1] < fall * (1.0 + 0.8) / (1.0 - 0.8) + 2.0 * h
