"""Kernels for systems with modes give, as plain Python, the very numbers that they give compiled."""

import pytest

from lagrangian import scenes
from lcpstep import EventDriven, simulate
from lcpstep.events.hybrid import machine, run
from lcpstep.maps import modes
from lcpstep.maps.batch import periods
from tests import uncompiled


@pytest.fixture
def as_sources(monkeypatch):
    def change():
        plain = uncompiled.kernels().mode_periods
        monkeypatch.setattr(machine, "Machine", plain.Machine)
        monkeypatch.setattr(run, "Motion", plain.Motion)
        monkeypatch.setattr(run, "Switching", plain.Switching)
        for name in ("Follow", "Placing", "Tangent"):
            monkeypatch.setattr(modes, name, getattr(plain, name))
        monkeypatch.setattr(modes, "follow", plain.go_through)

    return change


def test_a_motion_is_the_same_to_the_last_bit(as_sources):
    scene = scenes.stick_slip_oscillator(t_end=2.5)

    def found():
        motion = simulate(scene, EventDriven())
        return [x.tobytes() for x in (motion.t, motion.x, motion.switches.time, motion.pieces.dense)]

    whole = found()
    as_sources()
    assert found() == whole


@pytest.mark.parametrize("make", [scenes.dry_friction_oscillator, scenes.driven_bilinear_oscillator])
def test_maps_and_their_derivatives_are_the_same_to_the_last_bit(make, as_sources):
    scene = make(amplitude=0.9, omega=2.0)

    def found():
        return periods(scene, EventDriven(1e-6, 1e-6), [[0.2, 0.5]], 1, tangents=True)

    whole = found()
    as_sources()
    for name, value in vars(found()).items():
        assert getattr(whole, name).tobytes() == value.tobytes(), name
