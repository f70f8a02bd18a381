"""By Stronge's law a contact at rest that a blow elsewhere makes approach rebounds, whatever its rounding was."""

import numpy as np
import pytest

from lagrangian import Coulomb, LinearContacts, LinearSystem, Scene
from lcpstep import EventDriven, Moreau, simulate

R, H = 0.3, 1e-3


def disc(Q, t_end):
    """A disc that slides and turns on a floor, against a wall at its side, in turned coordinates."""
    rows, tangents = np.array([[0.0, 1.0, 0.0], [1.0, 0.0, 0.0]]), np.array([[1.0, 0.0, R], [0.0, 1.0, -R]])
    contacts = LinearContacts(
        rows @ Q, [0.0, 0.1], 0.5, friction=Coulomb([0.1, 0.4], tangents @ Q, law="stronge")
    )
    M = Q.T @ np.diag([1.0, 1.0, 0.5 * R * R]) @ Q
    system = LinearSystem(0.5 * (M + M.T), force=Q.T @ [0.0, -9.81, 0.0])
    return Scene(system, np.zeros(3), Q.T @ [-2.0, 0.0, -10.0], (0.0, t_end), contacts)


def test_a_disc_is_pressed_onto_the_floor_by_its_blow_against_a_wall():
    exact = simulate(disc(np.eye(3), 0.5), EventDriven())
    blow = next(x for x in exact.impacts if x["contact"] == 1)
    end = blow["time"] + 2.0 * H
    v = simulate(disc(np.eye(3), end), EventDriven(), keep=[end]).v[-1]
    for seed in range(12):
        Q, _ = np.linalg.qr(np.random.default_rng(seed).normal(size=(3, 3)))
        run = simulate(disc(Q, end), Moreau(H), keep=[end])
        assert Q @ run.v[-1] == pytest.approx(v, abs=0.1)
