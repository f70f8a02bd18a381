"""A run that goes on from the end of one at rest: its gaps, of 1e-18 m, are all the lengths that it has."""

import math
from dataclasses import replace

import numpy as np
import pytest
from scipy import sparse

from lagrangian import Contacts, Harmonic, LinearContacts, LinearSystem, Scene, System, scenes
from lcpstep import Moreau, simulate
from lcpstep.maps import periods

G, H, ROUNDED = 9.81, 1e-3, 1.7e-18


@pytest.mark.parametrize("method", [Moreau(H), Moreau(H, theta=1.0), Moreau(H, lcp="qp")], ids=str)
def test_a_pile_stays_where_it_stood(method):
    """Blocks sank by 5e-4 m: most of their feet were taken to be above the block below."""
    scene = scenes.stack(t_end=0.2)
    first = simulate(scene, method)
    run = simulate(replace(scene, q0=first.q[-1], v0=first.v[-1], t_span=(0.2, 0.4)), method)
    assert np.max(np.abs(run.q)) < 1e-16
    blocks = scene.n_q // 2
    weights = H * G * np.repeat(np.arange(blocks, 0.0, -1.0), 2) / 2.0
    np.testing.assert_allclose(run.impulse[1:], np.tile(weights, (len(run.t) - 1, 1)), rtol=1e-6)


@pytest.mark.usefixtures("sparse_steps")
@pytest.mark.parametrize("made", [np.asarray, sparse.csr_array])
@pytest.mark.parametrize(
    "force", [[0.0, 0.0, -G], Harmonic(constant=[0, 0, -G], sine=[0, 0, 0.5 * G], omega=3.0)]
)
def test_a_row_pushed_at_its_end_stays(made, force):
    """Bodies that no force of their own pushes are held by their neighbours from the first step on."""
    between = LinearContacts(made(np.eye(3) - np.eye(3, k=-1)), 0.0, 0.0)
    scene = Scene(
        LinearSystem(made(np.eye(3)), force=force), ROUNDED * np.array([1.0, 3.0, 6.0]), np.zeros(3), (0.0, 0.1),
        between,
    )  # fmt: skip
    run = simulate(scene, Moreau(H))
    assert np.max(np.abs(run.q)) < 1e-16
    assert np.all(run.impulse[1:] > 0.0)


def floor(t, q, v, p, out):
    out[0] = math.sin(q[0])


def upwards(t, q, v, p, out):
    out[0, 0] = math.cos(q[0])


def weight(t, q, v, p, out):
    out[0] = -2.0 * G


def test_a_general_system_stays():
    scene = Scene(
        System(1, [[2.0]], weight), [ROUNDED], [0.0], (0.0, 0.1), Contacts(1, floor, upwards, restitution=0.5)
    )
    assert np.max(np.abs(simulate(scene, Moreau(H)).q)) < 1e-16


def test_many_runs_side_by_side_stay_as_one_does():
    scene = Scene(
        LinearSystem([[1.0]], force=Harmonic(constant=[-G], cosine=[0.3 * G], omega=20.0 * math.pi)),
        [ROUNDED], [0.0], (0.0, 0.1), LinearContacts([[1.0]], 0.0, 0.5), period=0.1,
    )  # fmt: skip
    assert np.max(np.abs(simulate(scene, Moreau(H)).q)) < 1e-16
    found = periods(scene, Moreau(H), np.array([[ROUNDED, 0.0], [3.0 * ROUNDED, 0.0]]), 2)
    assert np.max(np.abs(found.states)) < 1e-16


def test_a_ball_just_above_its_floor_falls_onto_it():
    """A thousandth of what it falls in a step is a gap."""
    scene = Scene(
        LinearSystem([[1.0]], force=[-G]),
        [1e-3 * G * H * H],
        [0.0],
        (0.0, H),
        LinearContacts([[1.0]], 0.0, 0.5),
    )
    run = simulate(scene, Moreau(H))
    assert run.q[-1, 0] == pytest.approx(1e-3 * G * H * H - 0.5 * G * H * H, rel=1e-9)
