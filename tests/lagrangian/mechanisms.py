"""Mechanisms from their Lagrangian, one of them by hand too; what asks for them skips where there is no sympy."""

import functools
import math

import pytest

from lagrangian import Contacts, Scene, System

sympy = pytest.importorskip("sympy")
dynamicsymbols = pytest.importorskip("sympy.physics.mechanics").dynamicsymbols
symbolic = pytest.importorskip("lagrangian.symbolic")
derive = symbolic.derive
T = sympy.Symbol("t")
ARMS = {"m1": 1.0, "m2": 0.5, "l1": 1.0, "l2": 0.7, "g": 9.81}


@functools.cache
def pendulum():
    theta, (m, length, g) = dynamicsymbols("theta"), sympy.symbols("m length g", positive=True)
    x, y = length * sympy.sin(theta), -length * sympy.cos(theta)
    L = m * (x.diff(T) ** 2 + y.diff(T) ** 2) / 2 - m * g * y
    return derive(L, theta, parameters={m: 0.3, length: 0.5, g: 9.81}, gaps=x + 0.1, restitution=0.9)


def tip_and_lagrangian():
    angles, (m1, m2, l1, l2, g) = dynamicsymbols("theta1 theta2"), sympy.symbols("m1 m2 l1 l2 g")
    x1, y1 = l1 * sympy.sin(angles[0]), -l1 * sympy.cos(angles[0])
    x2, y2 = x1 + l2 * sympy.sin(angles[1]), y1 - l2 * sympy.cos(angles[1])
    squares = [x.diff(T) ** 2 + y.diff(T) ** 2 for x, y in ((x1, y1), (x2, y2))]
    return x2, (m1 * squares[0] + m2 * squares[1]) / 2 - g * (m1 * y1 + m2 * y2), angles


@functools.cache
def double_pendulum(restitution=1.0):
    """Its lower bob to the right of a wall at x = -0.3 m."""
    x2, L, angles = tip_and_lagrangian()
    return derive(L, angles, parameters=ARMS, gaps=[x2 + 0.3], restitution=restitution)


@functools.cache
def shaken_pendulum():
    """Pivot at A cos(w t), a wall below at A sin(w t)."""
    theta, (A, w) = dynamicsymbols("theta"), sympy.symbols("A w")
    x, y = sympy.sin(theta), A * sympy.cos(w * T) - sympy.cos(theta)
    L = (x.diff(T) ** 2 + y.diff(T) ** 2) / 2 - 9.81 * y
    return derive(L, theta, parameters={"A": 0.1, "w": 30.0}, gaps=[x - A * sympy.sin(w * T) + 0.5])


@functools.cache
def bead_on_turning_wire():
    """Straight wire that turns at W, with a stop at r = R."""
    r, (m, W, R) = dynamicsymbols("r"), sympy.symbols("m W R")
    x, y = r * sympy.cos(W * T), r * sympy.sin(W * T)
    L = m * (x.diff(T) ** 2 + y.diff(T) ** 2) / 2
    return derive(L, r, parameters={"m": 0.2, "W": 2.0, "R": 1.0}, gaps=[R - r], restitution=0.5)


@functools.cache
def sphere_in_moving_bowl():
    x, y, (m, R, A, w) = *dynamicsymbols("x y"), sympy.symbols("m R A w")
    gap = R - sympy.sqrt(x**2 + (y - A * sympy.sin(w * T)) ** 2)
    L = m * (x.diff() ** 2 + y.diff() ** 2) / 2 - m * 9.81 * y
    return derive(L, (x, y), parameters={"m": 0.2, "R": 5.0, "A": 0.3, "w": 2.0}, gaps=[gap, x * y + 20])


MECHANISMS = [pendulum, double_pendulum, shaken_pendulum, bead_on_turning_wire, sphere_in_moving_bowl]


def arms_mass(t, q, v, p, out):
    out[0, 0], out[1, 1] = (p[0] + p[1]) * p[2] ** 2, p[1] * p[3] ** 2
    out[0, 1] = out[1, 0] = p[1] * p[2] * p[3] * math.cos(q[0] - q[1])


def arms_force(t, q, v, p, out):
    s = p[1] * p[2] * p[3] * math.sin(q[0] - q[1])
    out[0] = -s * v[1] ** 2 - (p[0] + p[1]) * p[4] * p[2] * math.sin(q[0])
    out[1] = s * v[0] ** 2 - p[1] * p[4] * p[3] * math.sin(q[1])


def arms_gap(t, q, v, p, out):
    out[0] = p[2] * math.sin(q[0]) + p[3] * math.sin(q[1]) + 0.3


def arms_jacobian(t, q, v, p, out):
    out[0, 0], out[0, 1] = p[2] * math.cos(q[0]), p[3] * math.cos(q[1])


def arms_by_hand(q0, v0, t_span, restitution):
    return Scene(
        system=System(n_q=2, mass=arms_mass, force=arms_force),
        contacts=Contacts(n_c=1, gap=arms_gap, jacobian=arms_jacobian, restitution=restitution),
        q0=q0, v0=v0, t_span=t_span, parameters=ARMS,
    )  # fmt: skip
