"""A scene of coupled bodies by its family and seed; and the same one, begun elsewhere by next to nothing."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any, ClassVar

import numpy as np

from benchmarks.judge.coupled.heaps import heap
from benchmarks.judge.coupled.linkages import linkage
from benchmarks.judge.coupled.rods import rods
from lagrangian import Scene

FAMILIES = {"heaps": heap, "rods": rods, "linkages": linkage}


@dataclass(frozen=True)
class Coupled:
    """What the judge asks of a scene; `seed` is what its random numbers are made from.

    moved : by how much every coordinate is moved at the start, about, [m], [rad]; as a whole where joints hold it
    way : number of the random direction
    """

    family: str
    seed: int | tuple[int, ...]
    moved: float = 0.0
    way: int = 0
    h: ClassVar[float] = 5e-4

    @property
    def t_span(self) -> tuple[float, float]:
        """Of the scene."""
        return self.scene().t_span

    @property
    def length(self) -> float:
        """Span of time."""
        return self.t_span[1] - self.t_span[0]

    def scene(self) -> Scene:
        """The scene itself."""
        scene = FAMILIES[self.family](self.seed)
        rng, n = np.random.default_rng(self.way), len(scene.q0)
        off = rng.normal(size=n) if scene.joints is None else np.resize([*rng.normal(size=2), 0.0], n)
        return replace(scene, q0=scene.q0 + self.moved * off, name=self.family) if self.moved else scene


def coupled(seed: int, index: int) -> Coupled:
    """Scene number `index` of a seed."""
    return Coupled(str(np.random.default_rng([seed, index]).choice(sorted(FAMILIES))), (seed, index))


def energy(run: Any) -> Any:
    """Of motion and height, in states of a linear system under a constant force."""
    system = run.scene.system
    return 0.5 * np.sum(run.v * (run.v @ system.M), axis=1) - run.q @ np.asarray(system.force.constant)
