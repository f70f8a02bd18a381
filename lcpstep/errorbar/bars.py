"""What an error bar says: errors of positions, velocities, energy and impacts, and until when they are known."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class Bar:
    """Error of one quantity, each of whose k coordinates has its own.

    Attributes
    ----------
    sup : the largest error until the bar ends, of the coordinate where it is largest [unit]
    l1 : integral of the error over time, likewise [unit s]
    largest : (m, k)   the largest error until each time of the error bar [unit]
    integral : (m, k)   the integral until then [unit s]
    unit : of the quantity
    """

    largest: Array
    integral: Array
    unit: str

    @property
    def sup(self) -> float:
        """The largest error of all coordinates [unit]."""
        return float(np.max(self.largest[-1], initial=0.0))

    @property
    def l1(self) -> float:
        """The largest integral of all coordinates [unit s]."""
        return float(np.max(self.integral[-1], initial=0.0))

    def __str__(self) -> str:
        return f"{self.sup:.2g} {self.unit}"

    def __repr__(self) -> str:
        return f"Bar({self})"


@dataclass(frozen=True, eq=False)
class ErrorBar:
    """How far a run is from the motion that it stands for, by a companion of another method or tolerance.

    The bar is meant to be right within a factor of two, and is no bound. It holds from the start to `until`; there
    the two runs saw different events, or the motion can no longer be predicted, and `reason` says which.

    Attributes
    ----------
    t : (m,)   times of the functions of time [s]
    position : Bar, in the unit of the scene's coordinates
    velocity : Bar, likewise; `sup` leaves out the time between an impact and its partner in the companion, where one
        of the two velocities has jumped already, `left_out`; `l1` does not
    energy : Bar [J], of the kinetic energy and that of constant stiffness and forces; `sup` as for velocities
    impact_time, impact_impulse : (n_events,)   of every row of the impact log [s], [N s]; nan for what is no impact,
        has no partner, is weak (its jump below a fiftieth of the largest), follows another of its contact faster than
        the run resolves (that one has the error of the impulse of all), or comes after `until`
    until : end of the bar [s]
    reason : why it ends there, "" for a bar over the whole run
    horizon : time beyond which the run does not predict the motion: its error is a quarter of the range of the
        coordinate that moves most; infinite where that does not happen until the bar ends [s]
    companions : the runs that it comes from, in words
    left_out : (k, 2)   intervals that `sup` and `largest` of velocity and energy say nothing about [s]
    """

    t: Array
    position: Bar
    velocity: Bar
    energy: Bar
    impact_time: Array
    impact_impulse: Array
    until: float
    reason: str
    horizon: float
    companions: tuple[str, ...]
    left_out: Array

    @property
    def latest(self) -> float:
        """The largest error of an impact time, nan without impacts [s]."""
        return _largest(self.impact_time)

    @property
    def strongest(self) -> float:
        """The largest error of an impulse, nan without impacts [N s]."""
        return _largest(self.impact_impulse)

    def as_dict(self) -> dict[str, Any]:
        """The numbers over the span, by name and unit; null for what is not known."""
        bars = {"position": self.position, "velocity": self.velocity, "energy": self.energy}
        found: dict[str, Any] = {
            name: {"sup": bar.sup, "l1": bar.l1, "unit": bar.unit} for name, bar in bars.items()
        }
        found |= {"impact_time": self.latest, "impact_impulse": self.strongest, "until": self.until}
        found |= {"reason": self.reason, "horizon": self.horizon, "companions": list(self.companions)}
        return {k: None if isinstance(x, float) and not math.isfinite(x) else x for k, x in found.items()}

    def __str__(self) -> str:
        parts = [f"position {self.position}", f"velocity {self.velocity}", f"energy {self.energy}"]
        if math.isfinite(self.latest):
            unit = "N s" if self.energy.unit == "J" else "own units"
            parts.append(f"impacts {self.latest:.2g} s and {self.strongest:.2g} {unit}")
        end = f"; known up to t = {self.until:.6g} s: {self.reason}" if self.reason else ""
        return f"{', '.join(parts)} (by {'; '.join(self.companions) or 'no companion'}){end}"

    def __repr__(self) -> str:
        return f"ErrorBar({self})"


def _largest(x: Array) -> float:
    known = x[np.isfinite(x)]
    return float(np.max(known)) if len(known) else math.nan
