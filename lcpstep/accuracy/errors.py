"""Error measures for motions that jump: how far one motion lies from another.

    sup |q - q_ref|,   int |v - v_ref| dt,   Hausdorff distance of the filled-in graphs of v,
    impacts matched one to one,   int |E - E_ref| dt / T,   penetration

Velocities jump at different times in the two motions, so that their pointwise sup does not become small. Each
motion is evaluated through its own `at`, between all times of both grids and both impact logs: no interval of
integration straddles a jump that a log names. Of grids of more than `MOST` times one in several is looked at, which
changes the measures by less than a hundredth (tests/accuracy/test_errors.py). Sources: V. Acary, B. Brogliato,
Numerical Methods for Nonsmooth Dynamical Systems (Springer 2008), section 9; for the distance of graphs J. J. Moreau,
Approximation en graphe d'une evolution discontinue, RAIRO Analyse numerique 12, 1978.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property
from typing import Any, Protocol

import numpy as np
from numpy.typing import NDArray

from lagrangian import Scene, checks, labels
from lcpstep.accuracy.graphs import Graph, hausdorff
from lcpstep.accuracy.matching import Matching, match_impacts
from lcpstep.kernels import states
from lcpstep.kernels.gauss import gauss
from lcpstep.model import model

Array = NDArray[np.float64]
LOOKS = 2000  # instants looked at in any case, however coarse the grids
MOST = 100_000  # instants looked at, about, however fine the grids, and those about jumps
BESIDE = 2  # instants on either side of every jump or bend that are looked at in any case
BENDS = 5000  # of the velocity, the sharpest
ROUNDING = 32 * np.finfo(float).eps  # of a time: runs take one within a quarter of it for that of an event
NODES, _ = gauss(2)


class Motion(Protocol):
    """What a motion must have to be measured; `lcpstep.Trajectory` does."""

    @property
    def t(self) -> Array:
        """Times of its grid."""

    @property
    def impacts(self) -> Any:
        """Impact log."""

    @property
    def scene(self) -> Scene:
        """The scene it is a motion of."""

    def at(self, t: Any) -> tuple[Array, Array]:
        """States at any times, right limits."""


@dataclass(frozen=True, eq=False)
class Difference:
    """How far apart two motions of one scene are; every measure is an attribute, computed when first asked for.

    Parameters
    ----------
    motion, reference : two `Trajectory` objects that kept every step, or anything with t, at, impacts and scene
    t_end : the motions are compared up to this time; default: to the end of the shorter one [s]
    rate : in the distance of graphs one second counts like `rate` [m/s^2] times a second
    within, least : see `lcpstep.accuracy.matching.match_impacts`

    Raises
    ------
    ValueError   the motions have different numbers of coordinates, or no time in common, or `rate` is not positive
    """

    motion: Motion
    reference: Motion
    t_end: float | None = None
    rate: float = 1.0
    within: float | None = None
    least: float = 0.0

    def __post_init__(self) -> None:
        checks.has("motion", self.motion, "at", "a Trajectory")
        checks.has("reference", self.reference, "at", "a Trajectory")
        sizes = [m.at(m.t[:1])[0].shape[1] for m in (self.motion, self.reference)]
        if sizes[0] != sizes[1]:
            raise ValueError(f"reference: expected a motion of {sizes[0]} coordinates, got {sizes[1]}")
        start, end = self.span
        if not start < end:
            raise ValueError(
                f"reference: expected times in common with the motion, got {start:g} .. {end:g} s"
            )
        if not self.rate > 0.0:
            raise ValueError(f"rate: expected a positive number, got {self.rate!r}")

    @property
    def span(self) -> tuple[float, float]:
        """The times compared [s]."""
        both = (self.motion, self.reference)
        ends = [float(m.t[-1]) for m in both] + ([] if self.t_end is None else [float(self.t_end)])
        return max(float(m.t[0]) for m in both), min(ends)

    @cached_property
    def sup_position(self) -> float:
        """sup |q - q_ref| over time, of the coordinate where it is largest [m].

        Looked for at all times of both grids and logs and between them. Blind to velocities, to impulses and to
        impacts that hardly move anything; one early phase error in a fast motion fills it.
        """
        return max(_largest(np.abs(a[0] - b[0])) for a, b in (self._at_breaks, self._at_nodes))

    @cached_property
    def l1_velocity(self) -> float:
        """Integral of |v - v_ref| over time, of the coordinate where it is largest [m].

        An impact that comes d late costs d times its jump. Blind to short spikes however high, to rapid
        oscillation about the right velocity only in proportion to its size, and to what happens at an instant.
        """
        (_, v), (_, v_ref) = self._at_nodes
        return _largest(self._integral(np.abs(v - v_ref)))

    @cached_property
    def graph_distance(self) -> float:
        """Hausdorff distance of the graphs t -> v(t), jumps filled in, of the coordinate where it is largest [m/s].

        An impact that comes d late costs `rate` d, however strong it is; a missing impact costs as much as it
        jumps, however short the time to the next. This converges where the pointwise sup of v does not. Blind to
        how often a graph runs over the same place: two impacts at one time, or oscillations within a jump; and
        to couplings, for each coordinate is looked at alone.
        """
        t, v, v_ref = self._graphs
        t = self.rate * (t - t[0])
        if not (np.all(np.isfinite(v)) and np.all(np.isfinite(v_ref))):
            return math.inf
        distance = 0.0
        for k in np.argsort(np.abs(v - v_ref).mean(axis=0))[
            ::-1
        ]:  # probably the farthest first: it spares the rest
            distance = hausdorff(Graph(t, v[:, k]), Graph(t, v_ref[:, k]), distance)
        return distance

    @cached_property
    def impacts(self) -> Matching:
        """Impacts of the two logs matched one to one, see `Matching`.

        Blind to the motion between impacts and to contact forces; where impacts follow each other faster than
        the error of their times, partners are a matter of counting and not of physics.
        """
        start, end = self.span
        logs = [m.impacts[(m.impacts["time"] <= end)] for m in (self.motion, self.reference)]
        return match_impacts(logs[0], logs[1], end - start, self.within, self.least)

    @property
    def impact_time(self) -> float:
        """Largest time difference of matched impacts; blind to those without partner [s]."""
        return self.impacts.max_time

    @property
    def impact_impulse(self) -> float:
        """Largest difference of the impulses of matched impacts; blind to those without partner [N s]."""
        return self.impacts.max_impulse

    @property
    def unmatched(self) -> int:
        """Impacts of either motion that have no partner; blind to how strong they are."""
        return self.impacts.extra + self.impacts.missing

    @cached_property
    def energy(self) -> float:
        """Mean over time of |E - E_ref| [J]: kinetic energy, and that of constant stiffness and constant forces.

        A mean, for the energy jumps with the velocity. Blind to the phase of a motion and to errors that keep the
        energy; the potential of forces that the scene gives as functions, or that depend on time, is left out.
        """
        start, end = self.span
        E = [energies(self.motion.scene, self._times[1], *states) for states in self._at_nodes]
        return _largest(self._integral(np.abs(E[0] - E[1])[:, None])) / (end - start)

    @cached_property
    def penetration(self) -> float:
        """How deep the first motion lies within an obstacle, at most [unit of the gap]; no matter of the second.

        Looked at on both grids and between. Blind to contacts entered for less than the distance of these times.
        """
        states = (self._at_breaks[0], self._at_nodes[0])
        least = [least_gap(self.motion.scene, t, *x) for t, x in zip(self._times, states, strict=True)]
        return max(0.0, -min(least))

    @cached_property
    def _all_breaks(self) -> Array:
        """All times of both grids and logs within the span, and some more."""
        start, end = self.span
        times = [np.linspace(start, end, LOOKS + 1)]
        for m in (self.motion, self.reference):
            times += [np.asarray(m.t), np.asarray(m.impacts["time"], dtype=float)]
        t = np.unique(np.concatenate(times))
        return t[(t >= start) & (t <= end)]

    @cached_property
    def _kept(self) -> NDArray[np.intp]:
        """Which breaks are looked at."""
        t = self._all_breaks
        return np.arange(len(t)) if len(t) <= MOST else self._looked_at(t)

    @cached_property
    def _breaks(self) -> Array:
        """The breaks that are looked at."""
        return self._all_breaks[self._kept]

    def _looked_at(self, t: Array) -> NDArray[np.intp]:
        """Which of too many times to look at: one in several, so that they stay dense where the grids are, and all
        jumps and the sharpest bends of the velocity with their neighbours, where errors are largest and shortest.
        """
        both = (self.motion, self.reference)
        jumps = np.unique(np.concatenate([np.asarray(m.impacts["time"], dtype=float) for m in both]))
        acceleration = np.diff(self.motion.at(t)[1], axis=0) / np.diff(t)[:, None]
        bend = np.max(np.abs(np.diff(acceleration, axis=0)), axis=1)
        sharpest = np.argpartition(bend, -BENDS)[-BENDS:] + 1
        place = np.append(np.searchsorted(t, jumps[(jumps >= t[0]) & (jumps <= t[-1])]), sharpest)
        near = np.unique(np.clip(place[:, None] + np.arange(-BESIDE, BESIDE + 1), 0, len(t) - 1))
        every = np.append(np.arange(0, len(t), -(-len(t) // MOST)), len(t) - 1)
        return np.union1d(every, near)

    @cached_property
    def _times(self) -> tuple[Array, Array]:
        """The breaks, and the nodes of the quadrature between them."""
        t, kept = self._all_breaks, self._kept
        inner = (kept[:-1] + kept[1:] - 1) // 2  # the interval in the middle stands for those around it
        return t[kept], (t[inner, None] + (t[inner + 1] - t[inner])[:, None] * NODES).ravel()

    @cached_property
    def _at_breaks(self) -> tuple[tuple[Array, Array], tuple[Array, Array]]:
        return self.motion.at(self._times[0]), self.reference.at(self._times[0])

    @cached_property
    def _at_nodes(self) -> tuple[tuple[Array, Array], tuple[Array, Array]]:
        return self.motion.at(self._times[1]), self.reference.at(self._times[1])

    def _integral(self, x: Array) -> Array:
        """Over time, of values at the nodes (n, k)."""
        means = x.reshape(len(self._breaks) - 1, len(NODES), -1).mean(axis=1)
        return np.asarray(np.diff(self._breaks) @ means)

    @cached_property
    def _graphs(self) -> tuple[Array, Array, Array]:
        """Times, each jump's twice, and both velocities there: left limit, then right limit."""
        t, (start, end) = self._breaks, self.span
        both = (self.motion, self.reference)
        jumps = np.unique(np.concatenate([np.asarray(m.impacts["time"], dtype=float) for m in both]))
        jumps = jumps[(jumps > start) & (jumps <= end)]
        # A jump is looked at from a little before and after: the two motions may round its time differently.
        little = ROUNDING * max(abs(start), abs(end))
        place = np.searchsorted(t, jumps)
        seen = t.copy()
        seen[place] = np.minimum(jumps + little, end)
        seen = np.insert(seen, place, np.maximum(jumps - little, start))
        v, v_ref = (m.at(seen)[1] for m in both)
        return np.insert(t, place, jumps), v, v_ref


MEASURES = (
    "sup_position",
    "l1_velocity",
    "graph_distance",
    "impact_time",
    "impact_impulse",
    "unmatched",
    "energy",
    "penetration",
)


def units(scene: Scene) -> dict[str, str]:
    """Unit of each measure on a scene, where its coordinates have one in common; "1" for numbers."""
    q, v, energy = labels.units(scene.labels)
    impulse, length = (labels.own_unit(x, scene.labels) for x in ("N s", "m"))
    return {
        "sup_position": q, "l1_velocity": q, "graph_distance": v, "impact_time": "s",
        "impact_impulse": impulse or "own units", "unmatched": "1", "energy": energy, "penetration": length,
    }  # fmt: skip


def energies(scene: Scene, t: Array, q: Array, v: Array) -> Array:
    """Kinetic energy, and the potential of constant stiffness and constant forces, of states (n, n_q) [J]."""
    return np.asarray(states.energy(model(scene), *map(np.ascontiguousarray, (t, q, v))))


def least_gap(scene: Scene, t: Array, q: Array, v: Array) -> float:
    """The smallest gap of all contacts over states (n, n_q); infinite for a scene without contacts."""
    return float(
        np.min(states.extremes(model(scene), *map(np.ascontiguousarray, (t, q, v)))[0], initial=math.inf)
    )


def _largest(x: Array) -> float:
    """Infinite where a number is not finite."""
    return float(np.max(x, initial=0.0)) if np.all(np.isfinite(x)) else math.inf
