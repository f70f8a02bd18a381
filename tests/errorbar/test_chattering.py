"""Error bars where chattering ends: soon, at small speeds, with the largest error of the whole run."""

import numpy as np
import pytest

from benchmarks.judge.describe import Description
from lagrangian import LinearContacts, LinearSystem, Scene
from lcpstep import EventDriven, Located, Moreau, simulate
from lcpstep.trajectory import Kind

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


@pytest.mark.parametrize("tolerance", [1e-4, 3.5e-5])
@pytest.mark.parametrize("restitution", [0.3, 0.5])
def test_an_impact_that_the_run_does_not_tell_apart_from_the_one_before_has_no_error_of_its_own(
    restitution, tolerance
):
    """The last hops of a ball are shorter than its steps; what is known of the first is far too small for others."""
    ball = LinearSystem(M=1.0, force=[-9.81])
    scene = Scene(ball, 0.5, 0.0, (0.0, 6.0), LinearContacts(1.0, restitution=restitution))
    run = simulate(scene, Moreau(2e-2, tolerance=tolerance), error=True)
    told = run.error.impact_time[run.impacts.kind == Kind.IMPACT]
    first = np.sqrt(2.0 * 0.5 / 9.81)
    exact = first * (1.0 + 2.0 * np.cumsum(np.append(0.0, restitution ** np.arange(1.0, len(told)))))
    off, known = np.abs(run.impacts.time[run.impacts.kind == Kind.IMPACT] - exact), np.isfinite(told)
    assert np.count_nonzero(known) >= 4
    assert np.all(off[known] < 2.0 * told[known])
