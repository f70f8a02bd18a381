"""Mechanisms that several tests look at. Callbacks are plain functions of (t, q, v, p, out)."""

from __future__ import annotations

import math

from lagrangian import Contacts, LinearContacts, LinearSystem, Scene, System

GRAVITY = 9.81

# --- one coordinate


def TABLE(t, q, v, p, out):
    """Obstacle A sin(w t); p = (A, w)."""
    out[0, 0] = p[0] * math.sin(p[1] * t)
    out[0, 1] = p[0] * p[1] * math.cos(p[1] * t)
    out[0, 2] = -p[0] * p[1] * p[1] * math.sin(p[1] * t)


def ball_on_table(A, w, restitution, q0, v0, t_end):
    """Ball falling on the table A sin(w t)."""
    return Scene(
        system=LinearSystem(M=1.0, force=-GRAVITY),
        contacts=LinearContacts(G=1.0, restitution=restitution, motion=TABLE),
        q0=q0, v0=v0, t_span=(0.0, t_end), p=[A, w], period=2 * math.pi / w, name="table",
    )  # fmt: skip


def pendulum_force(t, q, v, p, out):
    """q'' = -sin q."""
    out[0] = -math.sin(q[0])


def pendulum_force_q(t, q, v, p, out):
    out[0, 0] = -math.cos(q[0])


def no_damping(t, q, v, p, out):
    for i in range(len(out)):
        for j in range(len(out)):
            out[i, j] = 0.0


def pendulum(angle, restitution, t_end, jacobians=True):
    """Pendulum of unit frequency that strikes a stop at its lowest point; from rest at `angle` > 0."""
    given = {"force_q": pendulum_force_q, "force_v": no_damping} if jacobians else {}
    return Scene(
        system=System(n_q=1, mass=1.0, force=pendulum_force, **given),
        contacts=LinearContacts(G=1.0, restitution=restitution),
        q0=angle, v0=0.0, t_span=(0.0, t_end), name="pendulum",
    )  # fmt: skip


# --- a point in the plane


def bowl_gap(t, q, v, p, out):
    out[0] = 1.0 - math.hypot(q[0], q[1])


def bowl_jacobian(t, q, v, p, out):
    r = math.hypot(q[0], q[1])
    out[0, 0], out[0, 1] = -q[0] / r, -q[1] / r


def bowl_bias(t, q, v, p, out):
    r = math.hypot(q[0], q[1])
    out[0] = -((q[0] * v[1] - q[1] * v[0]) ** 2) / r**3


BOWL = Contacts(n_c=1, gap=bowl_gap, jacobian=bowl_jacobian, bias=bowl_bias)


def bowl_scene(q0, v0, t_end, bias=True, restitution=0.0):
    """Point mass within the unit circle, under gravity."""
    contacts = Contacts(
        n_c=1, gap=bowl_gap, jacobian=bowl_jacobian, bias=bowl_bias if bias else None, restitution=restitution
    )
    return Scene(
        system=LinearSystem(M=[[1.0, 0.0], [0.0, 1.0]], force=[0.0, -1.0]),
        contacts=contacts, q0=q0, v0=v0, t_span=(0.0, t_end), name="bowl",
    )  # fmt: skip


def circle_gap(t, q, v, p, out):
    out[0] = math.hypot(q[0], q[1] - 0.5 * math.sin(2.0 * t)) - 1.0


def circle_jacobian(t, q, v, p, out):
    y = q[1] - 0.5 * math.sin(2.0 * t)
    r = math.hypot(q[0], y)
    out[0, 0], out[0, 1] = q[0] / r, y / r


def circle_gap_t(t, q, v, p, out):
    y = q[1] - 0.5 * math.sin(2.0 * t)
    out[0] = -y / math.hypot(q[0], y) * math.cos(2.0 * t)


def circle_bias(t, q, v, p, out):
    y, dy, ddy = q[1] - 0.5 * math.sin(2.0 * t), v[1] - math.cos(2.0 * t), 2.0 * math.sin(2.0 * t)
    r = math.hypot(q[0], y)
    out[0] = (q[0] * dy - y * v[0]) ** 2 / r**3 + y / r * ddy


RISING_CIRCLE = Contacts(
    n_c=1, gap=circle_gap, jacobian=circle_jacobian, gap_t=circle_gap_t, bias=circle_bias
)
