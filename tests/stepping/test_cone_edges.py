"""Forces that come to the edge of their cone and turn back: by the closed form of a pendulum on a rough cart."""

import numpy as np
import pytest
from scipy.special import ellipj

from benchmarks.judge.describe import Description
from lcpstep import Located, Status, simulate


@pytest.mark.parametrize("off", [0.0, 3e-12, -3e-12, 1e-11])
@pytest.mark.parametrize(("order", "error"), [(2, 1e-5), (4, 1e-8)])
def test_a_force_that_touches_the_edge_of_its_cone_holds(order, error, off):
    """A pendulum swings from one side to the other, where its push on the cart, 10 sin(q) N, is just mu N.

    There the force was found to leave its cone again and again, 1e-14 s further each time, for rounding of values
    that begin within their band. The cart stays; the angle is -2 asin(k cd(w t, k^2)), k = sin(pi/4), w^2 = 10.
    """
    cart = Description(
        M=((2.0, 0.0, 1.0), (0.0, 2.0, 0.0), (1.0, 0.0, 1.0)), q0=(0.0, 0.0, -0.5 * np.pi + off), v0=(0.0, 0.0, 0.0),
        t_span=(0.0, 5.0), h=1e-3, G=((0.0, 1.0, 0.0),), offset=(0.0,), constant=(0.0, -20.0, 0.0),
        T=((1.0, 0.0, 0.0),), mu=(0.5 * (1.0 - off),), pendulum=10.0, b=(0.0, 0.0, 1.0),
    )  # fmt: skip
    run = simulate(cart.scene(), Located(1e-3, order))
    assert run.status == Status.DONE
    _, cn, dn, _ = ellipj(np.sqrt(10.0) * run.t, 0.5)
    np.testing.assert_allclose(run.q[:, 2], -2.0 * np.arcsin(np.sqrt(0.5) * cn / dn), rtol=0, atol=error)
    np.testing.assert_allclose(run.q[:, 0], 0.0, rtol=0, atol=1e-8)
