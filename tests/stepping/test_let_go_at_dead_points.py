"""A slider between the walls of its guide: they let it go where the crank stands in line with the rod.

The force begins at zero there, and the crank turns by a tenth of a radian in a step: what rises slowly at first falls
by the error of a step of order two.
"""

from dataclasses import replace

import numpy as np
import pytest

from lagrangian import scenes
from lcpstep import Located, Status, simulate


@pytest.mark.parametrize("h", [4e-4, 7e-4, 1e-3, 2e-3])
def test_it_rises_once(h):
    """Of those that start 1e-6 faster, or slower, a fifth ended early with h = 1e-3, in events without end."""
    rng = np.random.default_rng(1)
    for k in range(30):
        scene = scenes.slider_crank(t_end=0.8)
        if k > 0:
            scene = replace(scene, v0=np.array(scene.v0) * (1.0 + 1e-6 * rng.normal()))
        run = simulate(scene, Located(h, max_per_step=20000), keep=np.linspace(0.1, 0.8, 8))
        assert run.status == Status.DONE, (k, run.message)
        assert all(np.all(scene.gap(*x)[0] > -1e-12) for x in zip(run.t, run.q, run.v, strict=True)), k
