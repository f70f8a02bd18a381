"""The functions of all judged scenes. Parameters p say what they do, so that nothing is compiled for a scene.

    row of p of a contact or joint: amplitude, phase, offset, bend, round, then N numbers G
    gap    g = G q + bend r(q) + offset - s(t),     r = |q|^2/2, or sqrt(round^2 + |q|^2) where round > 0
    motion s = amplitude S(omega t + phase),        S = sin, or a chain of parabolas with the same zeros
    force  f = F(t) - K q - C v - (pendulum sin s + spread cos(s) s'^2/4) b,    s = b q
    mass   M + spread (1 + sin(s)/2) b b^T

The last two have the kinetic energy v^T M v/2 + spread (1 + sin(s)/2) s'^2/2 and the potential -pendulum cos s.
"""

from __future__ import annotations

import math
from typing import Any

N, CONTACTS, JOINTS = 6, 8, 3  # most coordinates, contacts and joints
AMPLITUDE, PHASE, OFFSET, BEND, ROUND, G = range(6)
WIDTH = G + N
OMEGA, FORM = 0, 1
ROWS = 2
JOINT_ROWS = ROWS + CONTACTS * WIDTH
M = JOINT_ROWS + JOINTS * WIDTH
C, K = M + N * N, M + 2 * N * N
CONSTANT = K + N * N
COSINE, SINE, B, FRAME = CONSTANT + N, CONSTANT + 2 * N, CONSTANT + 3 * N, CONSTANT + 4 * N
FORCE_OMEGA, SPREAD, PENDULUM = FRAME + N, FRAME + N + 1, FRAME + N + 2
SIZE = PENDULUM + 1


def moved(angle: Any, omega: Any, form: Any, order: Any) -> Any:
    """S(omega t + phase), or its first or second derivative in time."""
    if form == 0.0:
        if order == 0:
            return math.sin(angle)
        if order == 1:
            return omega * math.cos(angle)
        return -omega * omega * math.sin(angle)
    half = math.floor(angle / math.pi)
    sign = 1.0 - 2.0 * (half - 2.0 * math.floor(0.5 * half))
    x = angle / math.pi - half
    rate = omega / math.pi
    if order == 0:
        return sign * 4.0 * x * (1.0 - x)
    if order == 1:
        return sign * 4.0 * (1.0 - 2.0 * x) * rate
    return -sign * 8.0 * rate * rate


def motion(t: Any, q: Any, v: Any, p: Any, out: Any) -> None:
    """Obstacles that move by themselves."""
    for i in range(out.shape[0]):
        k = ROWS + i * WIDTH
        for order in range(3):
            out[i, order] = p[k] * moved(p[0] * t + p[k + 1], p[0], p[1], order)


def frame(t: Any, q: Any, v: Any, p: Any, out: Any) -> None:
    """A frame that shakes."""
    for i in range(out.shape[0]):
        for order in range(3):
            out[i, order] = p[FRAME + i] * moved(p[0] * t, p[0], p[1], order)


def fill_gap(t: Any, q: Any, p: Any, at: Any, out: Any) -> None:
    """Gaps of the rows of p from place `at` on."""
    square = 0.0
    for j in range(len(q)):
        square += q[j] * q[j]
    for i in range(len(out)):
        k = at + i * WIDTH
        total = p[k + OFFSET]
        for j in range(len(q)):
            total += p[k + G + j] * q[j]
        if p[k + ROUND] > 0.0:
            total += p[k + BEND] * math.sqrt(p[k + ROUND] * p[k + ROUND] + square)
        else:
            total += 0.5 * p[k + BEND] * square
        out[i] = total - p[k] * moved(p[0] * t + p[k + 1], p[0], p[1], 0)


def fill_jacobian(q: Any, p: Any, at: Any, out: Any) -> None:
    """Their Jacobian."""
    square = 0.0
    for j in range(len(q)):
        square += q[j] * q[j]
    for i in range(out.shape[0]):
        k = at + i * WIDTH
        factor = p[k + BEND]
        if p[k + ROUND] > 0.0:
            factor /= math.sqrt(p[k + ROUND] * p[k + ROUND] + square)
        for j in range(len(q)):
            out[i, j] = p[k + G + j] + factor * q[j]


def fill_bias(t: Any, q: Any, v: Any, p: Any, at: Any, out: Any) -> None:
    """Their acceleration at v' = 0."""
    square, along, speed = 0.0, 0.0, 0.0
    for j in range(len(q)):
        square += q[j] * q[j]
        along += q[j] * v[j]
        speed += v[j] * v[j]
    for i in range(len(out)):
        k = at + i * WIDTH
        out[i] = p[k + BEND] * speed - p[k] * moved(p[0] * t + p[k + 1], p[0], p[1], 2)
        if p[k + ROUND] > 0.0:
            r = math.sqrt(p[k + ROUND] * p[k + ROUND] + square)
            out[i] += p[k + BEND] * (speed / r - along * along / (r * r * r) - speed)


def gap(t: Any, q: Any, v: Any, p: Any, out: Any) -> None:
    """Gaps of the contacts."""
    fill_gap(t, q, p, ROWS, out)


def jacobian(t: Any, q: Any, v: Any, p: Any, out: Any) -> None:
    """Jacobian of the contacts."""
    fill_jacobian(q, p, ROWS, out)


def gap_t(t: Any, q: Any, v: Any, p: Any, out: Any) -> None:
    """Rates of the contacts by themselves."""
    for i in range(len(out)):
        k = ROWS + i * WIDTH
        out[i] = -p[k] * moved(p[0] * t + p[k + 1], p[0], p[1], 1)


def bias(t: Any, q: Any, v: Any, p: Any, out: Any) -> None:
    """Accelerations of the contacts at v' = 0."""
    fill_bias(t, q, v, p, ROWS, out)


def joint_gap(t: Any, q: Any, v: Any, p: Any, out: Any) -> None:
    """Gaps of the joints."""
    fill_gap(t, q, p, JOINT_ROWS, out)


def joint_jacobian(t: Any, q: Any, v: Any, p: Any, out: Any) -> None:
    """Jacobian of the joints."""
    fill_jacobian(q, p, JOINT_ROWS, out)


def joint_bias(t: Any, q: Any, v: Any, p: Any, out: Any) -> None:
    """Accelerations of the joints at v' = 0."""
    fill_bias(t, q, v, p, JOINT_ROWS, out)


def phase_along(q: Any, p: Any) -> Any:
    """s = b q."""
    total = 0.0
    for j in range(len(q)):
        total += p[B + j] * q[j]
    return total


def mass(t: Any, q: Any, v: Any, p: Any, out: Any) -> None:
    """M + spread (1 + sin(s)/2) b b^T."""
    factor = p[SPREAD] * (1.0 + 0.5 * math.sin(phase_along(q, p)))
    for i in range(len(q)):
        for j in range(len(q)):
            out[i, j] = p[M + i * N + j] + factor * p[B + i] * p[B + j]


def force(t: Any, q: Any, v: Any, p: Any, out: Any) -> None:
    """All forces of a general system."""
    s, rate = phase_along(q, p), phase_along(v, p)
    along = p[PENDULUM] * math.sin(s) + 0.25 * p[SPREAD] * math.cos(s) * rate * rate
    c, z = math.cos(p[FORCE_OMEGA] * t), math.sin(p[FORCE_OMEGA] * t)
    for i in range(len(q)):
        total = p[CONSTANT + i] + p[COSINE + i] * c + p[SINE + i] * z - along * p[B + i]
        for j in range(len(q)):
            total -= p[K + i * N + j] * q[j] + p[C + i * N + j] * v[j]
        out[i] = total


def free_force(t: Any, q: Any, v: Any, p: Any, out: Any) -> None:
    """F(t) alone, as a function: of a linear system that does not know that its force is harmonic."""
    c, z = math.cos(p[FORCE_OMEGA] * t), math.sin(p[FORCE_OMEGA] * t)
    for i in range(len(q)):
        out[i] = p[CONSTANT + i] + p[COSINE + i] * c + p[SINE + i] * z
