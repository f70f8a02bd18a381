"""Two feet that meet a moving table at one instant, at any time: no rounding of that time strikes them in turn."""

import numpy as np
import pytest

from lagrangian import LinearContacts, LinearSystem, Scene
from lcpstep import EventDriven, Located, simulate

OMEGA, AMPLITUDE = 13.0, 0.03


def table(t, q, v, p, out):
    s, c = AMPLITUDE * np.sin(OMEGA * t), AMPLITUDE * np.cos(OMEGA * t)
    for k in range(2):
        out[k, 0], out[k, 1], out[k, 2] = s, OMEGA * c, -OMEGA * OMEGA * s


def feet(periods):
    """A body above the table, its height and its tilt, with feet of two restitutions."""
    start = periods * 2.0 * np.pi / OMEGA
    contacts = LinearContacts([[1.0, -0.5], [1.0, 0.5]], restitution=[1.0, 0.5], motion=table)
    system = LinearSystem(M=np.diag([1.0, 0.231]), force=(-9.81, 0.0))
    return Scene(system=system, contacts=contacts, q0=(0.1, 0.0), v0=(0.0, 0.0), t_span=(start, start + 0.3))


METHODS = [
    EventDriven(), EventDriven(1e-6, 1e-6), Located(0.01), Located(0.01, 4), Located(0.02, tolerance=1e-5),
    Located(0.02, 4, tolerance=1e-7),
]  # fmt: skip


@pytest.mark.parametrize("method", METHODS, ids=str)
def test_feet_strike_together_a_day_from_zero_too(method):
    near = simulate(feet(0), EventDriven())
    first = near.impacts[:2]
    for periods in (0, 1, 10**3, 10**4, 123_456, 2 * 10**5):
        struck = simulate(feet(periods), method).impacts[:2]
        assert set(struck["contact"]) == {0, 1}
        for c in (0, 1):
            own, other = struck[struck["contact"] == c][0], first[first["contact"] == c][0]
            np.testing.assert_allclose(own["after"], other["after"], atol=1e-4)
