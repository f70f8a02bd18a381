"""Bodies that run against steep sides, where no state has a gap nearer to zero than rounding times the slope."""

import numpy as np
import pytest

from benchmarks.audit.cases import ground, ground_bias, ground_q, swing
from lagrangian import Contacts, Scene, System
from lcpstep import Located, Status, simulate

TURN = 2.0 * np.pi


def along(height, width, at, phase):
    """A body that goes along at 1 m/s and swings, and meets a bump of the ground."""
    return Scene(
        system=System(2, np.eye(2), swing),
        contacts=Contacts(1, ground, ground_q, bias=ground_bias, restitution=0.8),
        q0=[0.0, np.cos(phase)], v0=[1.0, -TURN * np.sin(phase)], t_span=(0.0, 10.0),
        p=[height, width, at, 1.05], name="bump",
    )  # fmt: skip


@pytest.mark.parametrize("seed", range(3))
def test_a_steep_side_is_met_once(seed):
    rng = np.random.default_rng(seed)
    for _ in range(10):
        width, at, phase = 10.0 ** rng.uniform(-2.7, -1.7), rng.uniform(0.5, 9.5), rng.uniform(0.0, TURN)
        above = np.cos(TURN * at + phase) + 1.05
        scene = along(above + rng.uniform(0.2, 0.8), width, at, phase)
        m = simulate(scene, Located(1e-3, max_events=200))
        assert m.status == Status.DONE, (width, at, phase)
        t = np.linspace(at - 4.0 * width, at, 200_001)
        free = np.cos(TURN * t + phase) + 1.05 - scene.p[0] * np.exp(-(((t - at) / width) ** 2))
        assert m.impacts.time[0] == pytest.approx(t[np.argmax(free < 0.0)], abs=1e-4 * width + 2e-5)
