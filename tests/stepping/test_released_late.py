"""A contact let go at a wrong time by a step and by its halves alike: what both share is seen by a tolerance."""

import numpy as np
import pytest

from lagrangian import LinearContacts, Scene, System
from lcpstep import Located, Status, simulate


def pulled(t, q, v, p, out):
    out[0], out[1] = 0.2, -1.0


def table(t, q, v, p, out):
    """It sinks ever faster, until it leaves what lies on it behind."""
    out[0] = 2.0 * np.cos(t), -2.0 * np.sin(t), -2.0 * np.cos(t)


@pytest.mark.parametrize("h", [0.37, 0.9, 2.1])
@pytest.mark.parametrize("start", [-1.4, -1.3, -1.15])
@pytest.mark.parametrize("tolerance", [1e-3, 1e-6])
def test_a_table_that_falls_away_is_left_in_time(h, start, tolerance):
    """The motion on the table has no error, and both runs agree however long they hold: until cos t = 1/2."""
    scene = Scene(
        System(2, np.diag([1.0, 1.0]), pulled),
        q0=[0.0, 2.0 * np.cos(start)],
        v0=[0.0, -2.0 * np.sin(start)],
        t_span=(start, 0.1),
        contacts=LinearContacts([[0.0, 1.0]], [0.0], 0.0, motion=table),
    )
    m = simulate(scene, Located(h, tolerance=tolerance))
    left = -np.pi / 3.0
    flown = m.t[-1] - left
    assert m.status == Status.DONE
    assert m.impacts.time[-1] == pytest.approx(left, abs=0.1 * h)
    assert m.v[-1, 1] == pytest.approx(-2.0 * np.sin(left) - flown, abs=4.0 * tolerance)
    assert m.q[-1, 1] == pytest.approx(1.0 - 2.0 * np.sin(left) * flown - 0.5 * flown**2, abs=4.0 * tolerance)
