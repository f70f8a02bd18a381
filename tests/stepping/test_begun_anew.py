"""A run of steps that is begun anew from a state on the way is the same run."""

from dataclasses import replace

import numpy as np

from lagrangian import scenes
from lcpstep import Located, simulate


def test_a_step_of_order_four_begins_with_the_velocity_that_it_was_put_back_with():
    """The first step ends off the rod by its error and is put onto it; the next one had begun without that."""
    scene = replace(scenes.pendulum_stop(form="rod"), t_span=(0.0, 1.0))
    m = simulate(scene, Located(0.05, order=4))
    later = replace(scene, q0=m.q[1], v0=m.v[1], t_span=(float(m.t[1]), 1.0), exact=None)
    anew = simulate(later, Located(0.05, order=4))
    np.testing.assert_allclose(anew.q, m.q[1:], atol=1e-11)  # 5e-10
    np.testing.assert_allclose(anew.v, m.v[1:], atol=1e-11)
