"""A task as kernels see it: where its questions lie, and its answers go."""

from __future__ import annotations

import cython

from lcpstep.arrays import doubles, indices
from lcpstep.maps.task import ENDS, IMPACTS, Task


class Answers:
    """The arrays of a `Task`, row by row, and how long they are."""

    def __init__(self, task: Task) -> None:
        self.task = task
        self.t_start, self.t_end = task.t_start, task.t_end
        self.drop, self.periods, self.strict = task.drop, task.periods, task.strict
        self.runs, self.kept, self.most = task.impacts.shape[:3]
        self.n_targets, self.has_tangents = len(task.targets), task.tangents.shape[1] > 0
        self.starts, self.targets = doubles(task.starts), doubles(task.targets)
        self.radius, self.scale = doubles(task.radius), doubles(task.scale)
        self.states, self.impacts = doubles(task.states), doubles(task.impacts)
        self.landings, self.tangents = doubles(task.landings), doubles(task.tangents)
        self.final, self.counts = doubles(task.final), indices(task.counts)
        self.reached, self.taken, self.codes = indices(task.reached), indices(task.taken), indices(task.codes)

    def note_impact(self, i: int, k: int, t: float, before: float, after: float) -> None:
        """An impact in the k-th kept period of run i; the first ones in full, all by their number."""
        row = i * self.kept + k
        place = self.counts[2 * row + IMPACTS]
        if place < self.most:
            place += row * self.most
            self.impacts[3 * place], self.impacts[3 * place + 1] = t, before
            self.impacts[3 * place + 2] = after
        self.counts[2 * row + IMPACTS] += 1

    def note_landing(self, i: int, k: int, t: float) -> None:
        """The contact closes for good."""
        row = i * self.kept + k
        place = self.counts[2 * row + ENDS]
        if place < self.most:
            self.landings[row * self.most + place] = t
        self.counts[2 * row + ENDS] += 1
