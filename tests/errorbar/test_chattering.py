"""Error bars where chattering ends: soon, at small speeds, with the largest error of the whole run."""

import numpy as np
import pytest

from benchmarks.judge.describe import Description
from lcpstep import EventDriven, Located, simulate

GROOVE = Description(
    M=((2.69, 0.0), (0.0, 0.735)), q0=(-1.82, -0.054), v0=(-0.0994, 0.478), t_span=(0.0, 49.926), h=0.0795,
    G=((0.358, 0.934), (-0.943, 0.334)), offset=(3.681996, -1.386224), restitution=(0.77, 0.89),
    constant=(0.0, -7.21), frame=(-0.0447, 0.0306), omega=1.74, family="groove",
)  # fmt: skip


@pytest.mark.parametrize("h", [0.0552, 0.04])
def test_a_bar_of_order_four_looks_where_chattering_in_a_groove_ends(h):
    scene = GROOVE.scene()
    run, true = simulate(scene, Located(h, 4), error=True), simulate(scene, EventDriven(1e-13, 1e-13))
    t = np.linspace(*scene.t_span, 40_001)
    t = t[t <= run.error.until]
    (q, v), (exact_q, exact_v) = run.at(t)[:2], true.at(t)[:2]
    out = run.error.left_out
    row = np.searchsorted(out[:, 0], t, side="right") - 1
    free = (row < 0) | (t > out[np.maximum(row, 0), 1])
    assert 0.5 < np.max(np.abs(q - exact_q)) / run.error.position.sup < 2.0
    assert np.max(np.abs(v - exact_v)[free]) < 2.0 * run.error.velocity.sup
