"""A scene as plain numbers: it can be printed, transformed and shrunk, and the `Scene` is made from it."""

from __future__ import annotations

import math
from dataclasses import dataclass, fields
from typing import Any

import numpy as np

from benchmarks.judge import callbacks as f
from lagrangian import (
    Contacts,
    Coulomb,
    Harmonic,
    Joints,
    LinearContacts,
    LinearJoints,
    LinearSystem,
    Scene,
    System,
)  # fmt: skip

# Fields of a `Description` that have an entry for each contact
PER_ROW = (
    "G",
    "offset",
    "restitution",
    "amplitude",
    "phase",
    "bend",
    "round",
    "T",
    "mu",
    "mu_s",
    "slip",
    "sway",
)
Row = tuple[float, ...]
Rows = tuple[Row, ...]


def numbers(x: Any) -> Any:
    """An array as a row or rows of plain numbers."""
    return tuple(map(numbers, x)) if np.ndim(x) > 1 else tuple(map(float, x))


@dataclass(frozen=True)
class Description:
    """All numbers of a scene; what is left empty is zero. The symbols are those of `callbacks`.

    restitution : one number, or one for each contact
    h : the step that the motion asks for
    T, mu, mu_s, slip, law : of `Coulomb`, none without T; belts run by slip + sway cos(omega t)
    gaps, general, function : gaps, or all forces, or the force of a linear system as functions, whether they
        need it or not
    """

    M: Rows
    q0: Row
    v0: Row
    t_span: tuple[float, float]
    h: float
    G: Rows = ()
    offset: Row = ()
    restitution: Row | float = 0.0
    K: Rows = ()
    C: Rows = ()
    constant: Row = ()
    cosine: Row = ()
    sine: Row = ()
    force_omega: float = 0.0
    amplitude: Row = ()
    phase: Row = ()
    frame: Row = ()
    omega: float = 0.0
    form: int = 0
    bend: Row = ()
    round: Row = ()
    T: Rows = ()
    mu: Row = ()
    mu_s: Row = ()
    slip: Row = ()
    sway: Row = ()
    law: str = "moreau"
    J: Rows = ()
    joint_offset: Row = ()
    joint_bend: Row = ()
    gaps: bool = False
    general: bool = False
    function: bool = False
    spread: float = 0.0
    pendulum: float = 0.0
    b: Row = ()
    family: str = "scene"

    def __repr__(self) -> str:
        shown = [(x, getattr(self, x.name)) for x in fields(self)]
        return "Description({})".format(", ".join(f"{x.name}={v!r}" for x, v in shown if v != x.default))

    @property
    def n(self) -> int:
        """Number of coordinates."""
        return len(self.q0)

    @property
    def contacts(self) -> int:
        """Number of contacts."""
        return len(self.G)

    @property
    def curved(self) -> bool:
        """Whether a gap is no linear function of q."""
        return any(self.bend)

    @property
    def moving(self) -> bool:
        """Whether an obstacle or the frame moves by itself."""
        return any(self.amplitude) or any(self.frame)

    @property
    def belts(self) -> bool:
        """Whether surfaces run along themselves."""
        return any(self.slip) or any(self.sway)

    @property
    def nonlinear(self) -> bool:
        """Whether the equations of motion are."""
        return self.spread != 0.0 or self.pendulum != 0.0

    @property
    def bent(self) -> bool:
        """Whether a gap is no parabola in time under a constant acceleration, or joints force it off one."""
        return self.curved or self.moving or any(self.joint_bend)

    @property
    def length(self) -> float:
        """Span of time."""
        return self.t_span[1] - self.t_span[0]

    def matrix(self, name: str) -> Any:
        """M, C or K as an array (n, n)."""
        rows = getattr(self, name)
        return np.array(rows, dtype=float) if rows else np.zeros((self.n, self.n))

    def row(self, name: str, length: int | None = None) -> Any:
        """A row of numbers as an array, of zeros where it is empty."""
        values = getattr(self, name)
        return np.array(values, dtype=float) if values else np.zeros(self.n if length is None else length)

    def rates(self) -> Any:
        """Restitution of every contact."""
        return np.broadcast_to(np.asarray(self.restitution, dtype=float), (self.contacts,))

    def p(self) -> Any:
        """Parameters of the callbacks."""
        p, n = np.zeros(f.SIZE), self.n
        p[f.OMEGA], p[f.FORM] = self.omega, self.form
        _fill(p, f.ROWS, self, self.G, "amplitude", "phase", "offset", "bend", "round")
        _fill(p, f.JOINT_ROWS, self, self.J, "", "", "joint_offset", "joint_bend", "")
        for at, name in ((f.M, "M"), (f.C, "C"), (f.K, "K")):
            p[at : at + f.N * f.N].reshape(f.N, f.N)[:n, :n] = self.matrix(name)
        places = {f.CONSTANT: "constant", f.COSINE: "cosine", f.SINE: "sine", f.B: "b", f.FRAME: "frame"}
        for at, name in places.items():
            p[at : at + n] = self.row(name)
        p[f.FORCE_OMEGA], p[f.SPREAD], p[f.PENDULUM] = self.force_omega, self.spread, self.pendulum
        return p

    def scene(self) -> Scene:
        """The scene itself."""
        periods = [2.0 * math.pi / x for x in self.frequencies()]
        same = len(set(periods)) == 1
        return Scene(
            system=self._system(),
            contacts=self._contacts(),
            joints=self._joints(),
            q0=self.q0,
            v0=self.v0,
            t_span=self.t_span,
            p=self.p(),
            period=periods[0] if same else math.inf,
            corners=self._corners(periods[0] if same else math.inf),
            name=self.family,
        )

    def frame_force(self) -> Any:
        """Largest force of the frame on every coordinate."""
        size, w = np.abs(self.row("frame")), max(self.omega, 0.0)
        return sum(np.abs(self.matrix(x)) @ size * w**k for k, x in enumerate("KCM")) * (
            1.0 + 0.3 * self.form
        )

    def frequencies(self) -> list[float]:
        """Of everything that is driven from outside."""
        forced = any(self.cosine) or any(self.sine)
        return [self.force_omega] * forced + [self.omega] * (self.moving or any(self.sway))

    def _corners(self, period: float) -> Any:
        """Times at which parabolas follow each other, within a period or within the span."""
        if not (self.moving and self.form):
            return ()
        half, found = math.pi / self.omega, []
        start, end = (0.0, period) if math.isfinite(period) else self.t_span
        phases = {x for x, a in zip(self.phase, self.amplitude, strict=True) if a}
        phases |= {0.0} if any(self.frame) else set()
        for phase in phases:
            first = math.ceil(start / half + phase / math.pi)
            times = [
                (k - phase / math.pi) * half for k in range(first, first + int((end - start) / half) + 2)
            ]
            found += [t for t in times if start <= t < end]
        return found

    def _system(self) -> LinearSystem | System:
        if self.general or self.nonlinear:
            return System(n_q=self.n, mass=f.mass if self.spread else self.M, force=f.force)
        force = f.free_force if self.function else Harmonic(
            self.row("constant"), self.row("cosine"), self.row("sine"), self.force_omega
        )  # fmt: skip
        moving = f.frame if any(self.frame) else None
        return LinearSystem(self.M, self.C or None, self.K or None, force=force, frame=moving)

    def _contacts(self) -> LinearContacts | Contacts | None:
        if not self.G:
            return None
        moves = any(self.amplitude)
        if self.curved or self.gaps:
            return Contacts(
                self.contacts,
                f.gap,
                f.jacobian,
                f.gap_t if moves else None,
                f.bias,
                restitution=self.restitution,
                friction=self._friction(),
            )
        return LinearContacts(
            self.G,
            self.offset,
            self.restitution,
            motion=f.motion if moves else None,
            friction=self._friction(),
        )

    def _friction(self) -> Coulomb | None:
        if not self.T:
            return None
        slip = self.row("slip", self.contacts)
        moves = Harmonic(slip, self.row("sway", self.contacts), omega=self.omega) if any(self.sway) else slip
        return Coulomb(self.mu, self.T, moves, mu_s=self.mu_s or None, law=self.law)

    def _joints(self) -> LinearJoints | Joints | None:
        if not self.J:
            return None
        if any(self.joint_bend):
            return Joints(len(self.J), f.joint_gap, f.joint_jacobian, None, f.joint_bias)
        return LinearJoints(self.J, self.joint_offset)


def _fill(p: Any, at: int, d: Description, rows: Rows, *names: str) -> None:
    for i, row in enumerate(rows):
        k = at + i * f.WIDTH
        for place, name in enumerate(names):
            values = getattr(d, name) if name else ()
            p[k + place] = values[i] if values else 0.0
        p[k + f.G : k + f.G + len(row)] = row
