"""What a branch of periodic points is: its points, its bifurcations, and the steps it was followed in."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from lagrangian import checks

Array = NDArray[np.float64]


class Special(NamedTuple):
    """A special point of a branch; kind: fold, branch point, flip, torus, jump, or a name of the monitor's.

    It lies between the branch's points number `after` and `after` + 1.
    """

    kind: str
    p: float
    x: Array
    multipliers: NDArray[np.complex128]
    after: int = -1


@dataclass(frozen=True, eq=False)
class Branch:
    """Periodic points along a branch, in the order in which they were found.

    Attributes
    ----------
    p : (k,)   parameter
    x : (k, d)   points
    multipliers : (k, d)   of P^n
    special : the bifurcations located on the way
    ended : why the continuation ended, in words
    """

    p: Array
    x: Array
    multipliers: NDArray[np.complex128]
    special: tuple[Special, ...]
    ended: str

    @property
    def stable(self) -> NDArray[np.bool_]:
        """(k,) whether the points are stable."""
        return np.asarray(np.all(np.abs(self.multipliers) < 1.0, axis=1))

    def of_kind(self, kind: str) -> list[Special]:
        """The special points of one kind."""
        return [s for s in self.special if s.kind == kind]


@dataclass(frozen=True)
class Steps:
    """Step control: first, smallest and largest step, as shares of the parameter's range; most points."""

    first: float = 0.01
    smallest: float = 1e-7
    largest: float = 0.05
    points: int = 400

    def __post_init__(self) -> None:
        for name in ("first", "smallest", "largest"):
            checks.positive(name, getattr(self, name))
        checks.count("points", self.points)


@dataclass
class State:
    """A point of the branch with all that is known there."""

    z: Array
    J: Array
    slope: Array  # dF/dp
    tests: dict[str, float] = field(default_factory=dict)
