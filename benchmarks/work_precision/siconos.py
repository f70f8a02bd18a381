"""Siconos' Moreau-Jean time-stepping as a method that `lcpstep.study` can run.

The time loop is that of Siconos' C++ library where only the last state is wanted, and is driven from Python where
every state is; theta = 1/2 in both. Its seconds are those of the time loop alone, the model being built before the
clock starts: a choice in its favour.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from benchmarks.stepping.peer import Siconos
from lagrangian import Scene
from lcpstep import LcpStepError, Status, Trajectory
from lcpstep.recording import Kept
from lcpstep.trajectory import IMPACT_DTYPE, Counts


@dataclass(frozen=True)
class MoreauJean:
    """Moreau-Jean with step h [s] in the worker process; `seconds` collects the times it reports, by step."""

    h: float
    peer: Siconos = field(repr=False, compare=False, kw_only=True)
    seconds: dict[float, list[float]] = field(repr=False, compare=False, kw_only=True)

    def run(self, scene: Scene, kept: Kept, progress: Callable[[float], None]) -> Trajectory:
        """The motion of one of the scenes that the worker knows by name."""
        request: dict[str, Any] = {"scene": scene.name, "t_end": scene.t_span[1], "h": self.h}
        if not kept.all:
            answer = self.peer.ask(method="run", **request)
            if "error" in answer:
                raise LcpStepError(f"siconos: {answer['error']}")
            self.seconds.setdefault(self.h, []).append(answer["seconds"])
            rows = np.array([[scene.t_span[1], answer["q"], 0.0]])
        else:
            motion = self.peer.motion(method="python", **request)
            if isinstance(motion, str):
                raise LcpStepError(f"siconos: {motion}")
            rows = motion
        t, q, v = rows[:, 0], rows[:, 1:2], rows[:, 2:3]

        def between(times: Any) -> Any:
            return tuple(np.interp(times, t, x[:, 0])[:, None] for x in (q, v))

        return Trajectory(
            scene=scene, method=self, t=t, q=q, v=v, impulse=np.zeros_like(q),
            impacts=np.zeros(0, dtype=IMPACT_DTYPE).view(np.recarray), status=Status.DONE, message="",
            counts=Counts(steps=round(scene.t_span[1] / self.h)), dense=between,
        )  # fmt: skip
