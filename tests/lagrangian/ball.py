"""A ball above a floor, and its gap by functions."""

from lagrangian import LinearContacts, LinearSystem, Scene


def scene(**changes):
    """A ball above a floor, changed here and there."""
    usual = {"system": LinearSystem(M=1.0), "q0": 1.0, "v0": 0.0, "t_span": (0.0, 1.0)}
    return Scene(**{**usual, "contacts": LinearContacts(G=1.0), **changes})


def height(t, q, v, p, out):
    out[0] = q[0]


def upward(t, q, v, p, out):
    out[0, 0] = 1.0
