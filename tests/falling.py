"""A body of 1 kg that falls by 8 m/s^2 from 1 m, which it has fallen after half a second."""

from lagrangian import LinearContacts, LinearSystem, Scene, System
from lcpstep import simulate

FLOOR = LinearContacts(G=1.0, restitution=0.5)
FALLING = LinearSystem(M=1.0, force=-8.0)


def falling(force, p=(8.0,), t_end=0.5):
    return Scene(System(1, 1.0, force), 1.0, 0.0, (0.0, t_end), p=p)


def falls(t, q, v, p, out):
    out[0] = -8.0


def run(system, contacts, method, q0=1.0):
    return simulate(Scene(system, q0, 0.0, (0.0, 1.0), contacts), method)
