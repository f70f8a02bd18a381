"""Rods, wires, platforms, locked hinges as functions of (t, q, v, p, out); how far runs are from known motions."""

import math

import numpy as np
from scipy.special import ellipj, ellipk

from lagrangian import Joints, LinearSystem, Scene
from lcpstep import Located, simulate

G0 = 9.81


def swing(t, amplitude, w0):
    """Angle and rate of a pendulum let go at rest, w0 being its small-angle frequency."""
    k = math.sin(0.5 * amplitude)
    sn, cn, dn, _ = ellipj(ellipk(k * k) - w0 * np.asarray(t), k * k)
    return 2.0 * np.arcsin(k * sn), -2.0 * k * w0 * cn * dn / np.sqrt(1.0 - k * k * sn * sn)


def rod(t, q, v, p, out):
    out[0] = 0.5 * (q[0] * q[0] + q[1] * q[1] - 1.0)


def rod_jacobian(t, q, v, p, out):
    out[0, 0], out[0, 1] = q[0], q[1]


def point_on_a_rod(angle, t_end, contacts=None):
    return Scene(
        system=LinearSystem(M=np.eye(2), force=[0.0, -G0]), joints=Joints(1, rod, rod_jacobian), contacts=contacts,
        q0=[math.sin(angle), -math.cos(angle)], v0=[0.0, 0.0], t_span=(0.0, t_end), name="rod",
    )  # fmt: skip


def two_rods(t, q, v, p, out):
    out[0] = 0.5 * (q[0] ** 2 + q[1] ** 2 - 1.0)
    out[1] = 0.5 * ((q[2] - q[0]) ** 2 + (q[3] - q[1]) ** 2 - 1.0)


def two_rods_jacobian(t, q, v, p, out):
    for i in range(2):
        out[0, i], out[0, 2 + i] = q[i], 0.0
        out[1, i], out[1, 2 + i] = q[i] - q[2 + i], q[2 + i] - q[i]


def place(a, b):
    return np.array([math.sin(a), -math.cos(a), math.sin(a) + math.sin(b), -math.cos(a) - math.cos(b)])


def locked(t, q, v, p, out):
    out[0] = math.sin(q[0] - q[1])


def locked_jacobian(t, q, v, p, out):
    out[0, 0], out[0, 1] = math.cos(q[0] - q[1]), -math.cos(q[0] - q[1])


def wire(t, q, v, p, out):
    out[0] = math.cos(p[0] * t) * q[1] - math.sin(p[0] * t) * q[0]


def wire_jacobian(t, q, v, p, out):
    out[0, 0], out[0, 1] = -math.sin(p[0] * t), math.cos(p[0] * t)


def wire_rate(t, q, v, p, out):
    out[0] = -p[0] * (math.sin(p[0] * t) * q[1] + math.cos(p[0] * t) * q[0])


def shaker(t, q, v, p, out):
    out[0, 0], out[0, 1], out[0, 2] = math.sin(2.0 * t), 2.0 * math.cos(2.0 * t), -4.0 * math.sin(2.0 * t)


def platform(t, q, v, p, out):
    for i in range(3):
        x, y = q[0] + p[i] * math.cos(q[2]) - p[i], q[1] + p[i] * math.sin(q[2])
        out[i] = 0.5 * (x * x + y * y - 1.0)


def platform_jacobian(t, q, v, p, out):
    for i in range(3):
        c, s = p[i] * math.cos(q[2]), p[i] * math.sin(q[2])
        x, y = q[0] + c - p[i], q[1] + s
        out[i, 0], out[i, 1], out[i, 2] = x, y, -x * s + y * c


def parting(t, q, v, p, out):
    for i in range(2):
        out[i, 0] = out[i, 1] = out[i, 2] = 0.0
    if t > 0.5:
        out[1, 0], out[1, 1], out[1, 2] = (t - 0.5) ** 2, 2.0 * (t - 0.5), 2.0


def three_parting(t, q, v, p, out):
    out[0, 0] = out[0, 1] = out[0, 2] = 0.0
    parting(t, q, v, p, out[1:])


def errors_of(scene, levels, at, q, spread=(1.0,)):
    """Largest distance from the positions q at the times `at`; each level a mean over `spread`, no drift anywhere."""
    errors = []
    for n in levels:
        runs = [simulate(scene, Located(np.ptp(scene.t_span) / round(n * s)), keep=at) for s in spread]
        assert max(np.max(m.joint_drift) for m in runs) < 1e-12
        assert max(np.max(m.penetration, initial=0.0) for m in runs) < 1e-12
        errors.append(np.mean([np.max(np.abs(m.q - q)) for m in runs]))
    return errors
