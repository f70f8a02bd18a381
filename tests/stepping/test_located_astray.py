"""What slides on a moving obstacle and strikes another one, in steps chosen by a tolerance.

A step looks for the impact on its polynomial, and is then put onto the obstacle that it slides on: so the error of
that polynomial is in no state, but in the time of the impact.
"""

import numpy as np
import pytest
from scipy.optimize import brentq

from lagrangian import LinearContacts, LinearSystem, Scene
from lcpstep import Located, Status, simulate

AMPLITUDE, OMEGA, SPEED, AWAY, SLOPE = 0.0025, 60.0, 0.3, 0.2, 0.9


def floor(t, q, v, p, out):
    s, c = AMPLITUDE * np.sin(OMEGA * t), AMPLITUDE * np.cos(OMEGA * t)
    out[0, 0], out[0, 1], out[0, 2] = s, OMEGA * c, -OMEGA * OMEGA * s
    out[1, 0], out[1, 1], out[1, 2] = 0.0, 0.0, 0.0


def sliding():
    """A particle on a floor that moves up and down, before a slope."""
    contacts = LinearContacts([[0.0, 1.0], [-1.0, SLOPE]], offset=[0.0, AWAY], restitution=0.5, motion=floor)
    system = LinearSystem(M=np.eye(2), force=(0.0, -9.81))
    start = (SPEED, AMPLITUDE * OMEGA)
    return Scene(system=system, contacts=contacts, q0=(0.0, 0.0), v0=start, t_span=(0.0, 0.8))


def struck():
    """When gap 1 closes: AWAY - SPEED t + SLOPE AMPLITUDE sin(OMEGA t) = 0."""
    return brentq(lambda t: AWAY - SPEED * t + SLOPE * AMPLITUDE * np.sin(OMEGA * t), 0.6, 0.75, xtol=1e-15)


@pytest.mark.parametrize("h", [0.05, 0.1])
@pytest.mark.parametrize(("order", "tolerances"), [(2, (1e-3, 1e-5, 1e-7)), (4, (1e-5, 1e-7, 1e-9, 1e-11))])
def test_the_impact_comes_as_late_as_the_tolerance_tells(order, tolerances, h):
    for tolerance in tolerances:
        run = simulate(sliding(), Located(h, order, tolerance=tolerance))
        log = run.impacts
        first = log["time"][(log["contact"] == 1) & (log["before"] < 0.0)][0]
        assert run.status == Status.DONE
        assert SPEED * abs(first - struck()) < 10.0 * tolerance
