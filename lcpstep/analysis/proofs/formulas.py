"""A scene as formulas: what a proof can be given of, and the refusal of everything else.

With the phase theta = omega t, y = q + c the absolute coordinates (c the motion of the frame) and w = dy/dtheta,

    dy/dtheta = w,   dw/dtheta = M^-1 (F(theta)/omega^2 - C w/omega - K y/omega^2),
    g_c = G_c y - o_c(theta),   o_c = G_c c + s_c - offset_c,
    w+ = w - (1 + r) M^-1 G^T (G M^-1 G^T)^-1 (G w - o'),

linear in z = (y, w, 1, cos(k theta), sin(k theta)): dz/dtheta = (A0 + A1/omega + A2/omega^2) z. All numbers are
taken as the scene has them, but for frequencies: each is a whole multiple of omega, a turn of which is the period.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from flint import arb, arb_mat

from lagrangian import Harmonic as Force
from lagrangian import HybridScene, LinearContacts, LinearSystem, Scene
from lagrangian.profiles import rotating_cam
from lagrangian.scenes.table import sine_table
from lagrangian.system import TURN
from lcpstep.analysis.proofs.errors import NotProved
from lcpstep.analysis.proofs.obstacles import Harmonic, Obstacle, Sum, turning_cam
from lcpstep.analysis.proofs.written import Written, on_series

EQUAL = 16 * np.finfo(float).eps  # relative: frequencies that are meant to be multiples of one


@dataclass(frozen=True)
class Contact:
    """A contact: row of G, M^-1 G^T (G M^-1 G^T)^-1, restitution, and its obstacle o."""

    G: list[arb]
    lever: list[arb]
    restitution: arb
    obstacle: Obstacle


@dataclass(frozen=True)
class Formulas:
    """A scene as formulas; see the head of the file.

    frame : (n,) c, of which the scene's q is relative;  written : whether an obstacle is a user's function
    remembered : matrix exponentials that have been computed, see `lcpstep.analysis.proofs.shooting.propagator`
    """

    n: int
    omega: arb
    multiple: int
    A0: arb_mat
    A1: arb_mat
    A2: arb_mat
    contacts: tuple[Contact, ...]
    frame: tuple[Obstacle, ...]
    written: bool
    remembered: dict[Any, list[arb_mat]] = field(default_factory=dict)


def formulas(scene: Scene | HybridScene) -> Formulas:
    """The scene as formulas, at the precision of the moment.

    Raises
    ------
    NotProved   the scene is none that a proof can be given of
    """
    scene, system, contacts = _parts(scene)
    force, n = system.force, system.n_q
    assert isinstance(force, Force)
    pulled = force.omega != 0.0 and any(np.any(x) for x in force.terms(n)[1:])
    frequencies = {"force": float(force.omega)} if pulled else {}
    p = np.asarray(scene.p).tolist()
    moving = {"system.frame": system.frame, "contacts.motion": contacts.motion}
    for name, f in moving.items():
        if f is rotating_cam or f is sine_table:
            frequencies[name] = float(p[0] if f is rotating_cam else p[1])
    written = any(f not in (None, rotating_cam, sine_table) for f in moving.values())
    if not frequencies and not written:
        raise NotProved(f"{scene.name}: nothing forces the motion, so that no orbit of it is isolated")
    omega, multiples = _base(scene, frequencies)
    frame, motion = (
        [_moved(name, f, p, rows, c, multiples, omega) for c in range(rows)]
        for (name, f), rows in zip(moving.items(), (n, contacts.n_c), strict=True)
    )
    k = multiples.get("force", 1)
    M_inverse, C, K = _balls(system.M).inv(), _balls(system.C), _balls(system.K)
    return Formulas(
        n=n, omega=omega, multiple=k, A0=_unforced(n, k), A1=_with_blocks(n, -1 * (M_inverse * C), n),
        A2=_pulled(_with_blocks(n, -1 * (M_inverse * K), 0), M_inverse, force),
        contacts=tuple(_contact(contacts, c, M_inverse, frame, motion[c]) for c in range(contacts.n_c)),
        frame=tuple(frame), written=written,
    )  # fmt: skip


def _parts(scene: Scene | HybridScene) -> tuple[Scene, LinearSystem, LinearContacts]:
    """The scene, its system and its contacts, where these are linear."""
    name = scene.name
    if isinstance(scene, HybridScene):
        raise NotProved(f"{name}: a system with modes; proofs are for linear systems with contacts")
    if not isinstance(scene.system, LinearSystem):
        raise NotProved(f"{name}: the system is nonlinear (a System); proofs are for a LinearSystem")
    if not isinstance(scene.system.force, Force):
        raise NotProved(
            f"{name}: system.force is a callback, which cannot be enclosed; expected a Harmonic or constant force"
        )
    if scene.n_j:
        raise NotProved(f"{name}: the scene has joints")
    if scene.contacts is None:
        raise NotProved(f"{name}: the scene has no contacts")
    if not isinstance(scene.contacts, LinearContacts):
        raise NotProved(f"{name}: the gaps are nonlinear (Contacts); proofs are for LinearContacts")
    if scene.contacts.friction is not None:
        raise NotProved(f"{name}: the contacts have friction")
    return scene, scene.system, scene.contacts


def _base(scene: Scene, frequencies: dict[str, float]) -> tuple[arb, dict[str, int]]:
    """The frequency that belongs to the scene's period, and what multiple of it each of the others is."""
    if not math.isfinite(scene.period):
        raise NotProved(f"{scene.name}: the scene has no period")
    turns = {name: value * scene.period / (2.0 * math.pi) for name, value in frequencies.items()}
    multiples = {name: round(x) for name, x in turns.items()}
    for name, x in turns.items():
        if multiples[name] == 0 or abs(x - multiples[name]) > TURN:
            raise NotProved(
                f"{scene.name}: the period, {scene.period!r} s, is no whole number of turns of the {name}"
            )
    if not frequencies:
        return 2 * arb.pi() / arb(scene.period), {}
    first = next(iter(frequencies))
    omega = arb(frequencies[first]) / multiples[first]
    for name, value in frequencies.items():
        if abs(value - multiples[name] * float(omega)) > EQUAL * abs(value):
            raise NotProved(f"{scene.name}: the frequencies of {first} and {name} are no multiples of one")
    return omega, multiples


def _moved(
    name: str, f: Any, p: list[float], rows: int, c: int, multiples: dict[str, int], omega: arb
) -> Obstacle:
    """Row c of what moves an obstacle or the frame."""
    if f is None:
        return Sum(arb(0))
    if f is rotating_cam:
        return turning_cam(p, multiples[name])
    if f is sine_table:
        return Harmonic(arb(p[0]), multiples[name], arb(p[2]))
    return Written(name, on_series(name, f), tuple(p), rows, c, omega)


def _contact(
    contacts: LinearContacts, c: int, M_inverse: arb_mat, frame: list[Obstacle], motion: Obstacle
) -> Contact:
    row = _balls(_dense(contacts.G)[c : c + 1])
    response = M_inverse * row.transpose()
    lever = response * (1 / (row * response)[0, 0])
    restitution = arb(float(np.asarray(contacts.restitution)[c]))
    moved = [(arb(1), motion), *zip(row.entries(), frame, strict=True)]
    still = tuple((factor, part) for factor, part in moved if not isinstance(part, Sum))
    obstacle = Sum(-arb(float(np.asarray(contacts.offset)[c])), still)
    return Contact(row.entries(), lever.entries(), restitution, obstacle)


def _unforced(n: int, k: int) -> arb_mat:
    """A0: dy/dtheta = w, and the harmonics of the force."""
    A = arb_mat(2 * n + 3, 2 * n + 3)
    for i in range(n):
        A[i, n + i] = 1
    A[2 * n + 1, 2 * n + 2], A[2 * n + 2, 2 * n + 1] = -k, k
    return A


def _with_blocks(n: int, block: arb_mat, column: int) -> arb_mat:
    """A matrix of z that gives dw/dtheta from one part of z."""
    A = arb_mat(2 * n + 3, 2 * n + 3)
    for i in range(n):
        for j in range(n):
            A[n + i, column + j] = block[i, j]
    return A


def _pulled(A: arb_mat, M_inverse: arb_mat, force: Force) -> arb_mat:
    """A2 with the force in it."""
    n = M_inverse.nrows()
    for at, amplitude in enumerate(force.terms(n)):
        column = M_inverse * arb_mat(n, 1, amplitude.tolist())
        for i in range(n):
            A[n + i, 2 * n + at] += column[i, 0]
    if force.omega == 0.0:  # the cosine is a constant then
        for i in range(n):
            A[n + i, 2 * n] += A[n + i, 2 * n + 1]
            A[n + i, 2 * n + 1] = 0
    return A


def _balls(x: Any) -> arb_mat:
    return arb_mat(_dense(x).tolist())


def _dense(x: Any) -> Any:
    """A matrix as an array; one of scipy.sparse is filled up."""
    return x.toarray() if hasattr(x, "toarray") else np.asarray(x)
