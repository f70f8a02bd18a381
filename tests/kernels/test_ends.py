"""Where the rows of a model's matrices begin and end: what kernels leave out is zero."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

from lagrangian import LinearContacts, LinearSystem, Scene
from lcpstep import EventDriven, Located, Moreau, simulate
from lcpstep.model import ends

SHAPE = st.tuples(st.integers(0, 4), st.integers(0, 5))


@settings(deadline=None)
@given(
    SHAPE.flatmap(
        lambda shape: st.tuples(
            *2 * [arrays(float, shape, elements=st.sampled_from([0.0, -0.0, 2.0, np.nan]))]
        )
    )
)
def test_nothing_but_zeros_lies_outside_and_no_zeros_at_the_ends(pair):
    for i, (begin, end) in enumerate(ends(*pair)):
        some = np.any([row[i] != 0.0 for row in pair], axis=0)
        assert not some[:begin].any()
        assert not some[end:].any()
        assert begin == end == 0 or (some[begin] and some[end - 1])


def chain(order, n=12):
    """Beads of different masses with weak springs between neighbours, their coordinates in this order."""
    rng = np.random.default_rng(3)
    G = np.diff(np.eye(n), axis=0)
    M, K, f = rng.uniform(0.5, 2.0, n), 0.1 * G.T @ G, rng.normal(size=n)
    q, v = np.arange(1.0, n + 1.0), rng.normal(size=n)
    contacts = LinearContacts(G[:, order], 0.0, 0.6)
    system = LinearSystem(np.diag(M[order]), K=K[np.ix_(order, order)], force=f[order])
    return Scene(system, q[order], v[order], (0.0, 2.0), contacts)


@pytest.mark.parametrize(
    "method", [Moreau(1e-3), Located(1e-2), Located(1e-2, order=4), EventDriven()], ids=str
)
def test_a_motion_does_not_depend_on_the_order_of_coordinates(method):
    """Rows are short where neighbours stand side by side, and long where they do not."""
    order = np.random.default_rng(4).permutation(12)
    one, other = (simulate(chain(k), method, keep=[2.0]) for k in (np.arange(12), order))
    assert len(one.impacts) == len(other.impacts) > 5
    np.testing.assert_allclose(one.q[-1][order], other.q[-1], rtol=0, atol=1e-9)
    np.testing.assert_allclose(one.v[-1][order], other.v[-1], rtol=0, atol=1e-8)
