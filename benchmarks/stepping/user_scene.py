"""Two scenes as a user would write them, with callbacks that the library has never seen."""

import math

from lagrangian import LinearContacts, LinearSystem, Scene, System


def gusts(t, q, v, p, out):
    out[0] = p[0] * math.cos(p[1] * t) + 0.3 * math.cos(3.7 * t)


def cubic_spring(t, q, v, p, out):
    out[0] = p[0] * math.cos(p[1] * t) - 0.1 * v[0] - q[0] - q[0] ** 3


def linear(t_end: float = 10.0) -> Scene:
    """Oscillator below a stop, under a force given as a function."""
    return _scene(LinearSystem(M=1.0, C=0.1, K=1.0, force=gusts), t_end, "user-linear")


def nonlinear(t_end: float = 10.0) -> Scene:
    """Duffing's oscillator below a stop."""
    return _scene(System(n_q=1, mass=1.0, force=cubic_spring), t_end, "user-nonlinear")


def _scene(system: LinearSystem | System, t_end: float, name: str) -> Scene:
    stop = LinearContacts(G=-1.0, offset=0.5, restitution=0.8)
    return Scene(system=system, contacts=stop, q0=0.0, v0=0.0, t_span=(0.0, t_end), p=(1.0, 1.3), name=name)
