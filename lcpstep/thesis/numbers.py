"""Numbers printed in the thesis beside the computed ones, each with the independent check that stands behind it.

`digits` says to how many decimals the computed number is known; it is written with no more.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import lru_cache
from typing import Any

import numpy as np
from numpy.typing import NDArray

from lagrangian import Scene
from lagrangian.scenes import cam_follower, hybrid_abs
from lagrangian.scenes.cam_follower import NOSE_END, NOSE_START, detachment_rpm
from lcpstep import EventDriven
from lcpstep.analysis.abs_cycle import limit_cycle, peak
from lcpstep.analysis.abs_parameters import vanishing
from lcpstep.analysis.border_collision import PiecewiseLinearMap, classify
from lcpstep.analysis.chattering import Crossing, corner_crossings
from lcpstep.analysis.continuation import Steps
from lcpstep.analysis.corner_branches import ROUNDING, uncertainty
from lcpstep.analysis.corners import corner_impact, local_map
from lcpstep.analysis.normal_form import NormalForm, normal_form
from lcpstep.analysis.orbits import continue_orbit, periodic_orbit
from lcpstep.maps import periods

Array = NDArray[np.float64]
END = NOSE_END - 1e-14  # of the nose, on its own side
MATRICES = ("A_minus", "A_plus", "B_minus", "B_plus", "C", "D")
SWITCHINGS = ("0.147", "0.419", "0.517")  # of the controller's cycle, in the order of time
PROBE = 1e3  # errors by which an entry is moved, above rounding


@dataclass(frozen=True)
class Number:
    """One number.

    Attributes
    ----------
    chapter, what : where it stands, and what it is
    printed : as in the thesis; empty where only a picture is shown
    computed : the number of this library
    decimals : of it that are known
    check : how it is known
    """

    chapter: int
    what: str
    printed: str
    computed: float
    decimals: int
    check: str

    @property
    def text(self) -> str:
        """The computed number, with the decimals that are known."""
        return f"{self.computed:.{self.decimals}f}"

    @property
    def agreement(self) -> str:
        """How many of the printed digits agree, rounding allowed for."""
        return agreement(self.printed, self.computed)


def agreement(printed: str, computed: float) -> str:
    """In words: "all 6", or how many of how many digits, and by how much the printed number is off."""
    text = printed.strip().lstrip("~").strip()
    try:
        value = float(text)
    except ValueError:
        return ""
    decimals = len(text.partition(".")[2])
    digits = len(text.lstrip("-").replace(".", "").lstrip("0"))
    if abs(round(computed, decimals) - value) < 0.5 * 10.0**-decimals:
        return f"all {digits}" if digits else "yes"
    if printed.strip().startswith("~") and abs(computed - value) < 10.0**-decimals:
        return f"all {digits}, as about"
    known = next((k for k in range(decimals, -digits, -1) if round(computed, k) == round(value, k)), -digits)
    return f"{max(0, digits - (decimals - known))} of {digits}; printed is {value - computed:+.2g} off"


def numbers() -> list[Number]:
    """All of them, in the order of the chapters."""
    return [number for part in PARTS for number in part()]


def _cam(rpm: float) -> Scene:
    return cam_follower(rpm=rpm)


def _from_rest(rpm: float) -> Scene:
    return cam_follower(rpm=rpm, q0=0.0, v0=0.0)


@lru_cache(maxsize=1)
def _crossings() -> list[Crossing]:
    found = corner_crossings(_from_rest, (119.7, 125.0), impacts=5)
    return found + [
        c for ends in ((136.3, 136.4), (198.5, 198.6)) for c in corner_crossings(_from_rest, ends, impacts=0)
    ]


def _crossing(event: str, number: int, corner: int) -> float:
    return next(
        c.p for c in _crossings() if (c.sequence, c.event, c.number, c.corner) == (0, event, number, corner)
    )


def _chattering() -> list[Number]:
    exact = "closed form: c'' = -(k/m) c at the corner"
    known = "event of the event-driven run, located on the corner; bisection in 110 digits"
    rows = [
        Number(4, "first detachment [rpm]", "114.979", detachment_rpm(NOSE_START), 9, exact),
        Number(4, "detachment reaches the end of the nose [rpm]", "134.873", detachment_rpm(END), 9, exact),
    ]
    for printed, number in (("120.7356", 5), ("121.107", 4), ("121.686", 3), ("122.699", 2), ("124.998", 1)):
        what = f"bubble: impact {number} of the first sequence meets the corner c [rpm]"
        rows.append(Number(4, what, printed, _crossing("impact", number, 2), 9, known))
    for printed, corner, name in (("119.72", 2, "c"), ("136.38", 3, "d")):
        what = f"the first accumulation point meets the corner {name} [rpm]"
        rows.append(Number(4, what, printed, _crossing("accumulation", 0, corner), 9, known))
    what = "end of chattering of period one: its accumulation point meets the corner b of the next turn [rpm]"
    rows.append(Number(4, what, "~198", _crossing("accumulation", 0, 1), 9, known))
    return rows


def bisected(holds: Callable[[float], bool], inside: float, outside: float, width: float) -> float:
    """Where a property that holds at `inside` and not at `outside` is lost."""
    if not holds(inside) or holds(outside):
        raise ValueError(f"expected the property at {inside:g} and not at {outside:g}")
    while abs(outside - inside) > width:
        middle = 0.5 * (inside + outside)
        inside, outside = (middle, outside) if holds(middle) else (inside, middle)
    return 0.5 * (inside + outside)


def _upper() -> list[Number]:
    one = periodic_orbit(_cam(735.0), periods(_cam(735.0), EventDriven(), [1.0, -70.0], 400).final[0])
    way = continue_orbit(_cam, one, 735.0, (734.0, 745.0))
    (flip,) = (s.p for s in way.special if s.kind == "flip")
    start = periods(_cam(739.35), EventDriven(), [0.8, -74.0], 6000).final[0]
    two = periodic_orbit(_cam(739.35), start, 2)
    steps = Steps(first=0.001, largest=0.02)
    (corner,) = (
        s.p
        for s in continue_orbit(_cam, two, 739.35, (739.0, 742.0), steps=steps).special
        if s.kind == "corner"
    )
    crisis = bisected(_narrow, 740.0, 740.4, 1e-3)
    return [
        Number(4, "flip of O(1, 1) [rpm]", "~739", flip, 6, "det(DP + 1) = 0, DP by saltation matrices"),
        Number(4, "O(2, 2) meets the corner c, and is lost in chaos [rpm]", "739.378", corner, 6,
               "impact located on the corner; a multiplier jumps there to -3.99"),
        Number(4, "the chaotic attractor grows at once [rpm]", "740.2", crisis, 1,
               "bisection on runs of 20000 periods: not later than this"),
    ]  # fmt: skip


def _narrow(rpm: float) -> bool:
    """Whether the attractor is that of the band which the flip began, not the wide one."""
    run = periods(_cam(rpm), EventDriven(), [0.8, -74.0], 20_000, drop=500, most=0)
    return float(np.ptp(run.states[0][:, 0])) < 0.4


def _corner() -> list[Number]:
    x = periods(_cam(700.0), EventDriven(), [0.4, 0.4], 400).final[0]
    orbit = corner_impact(_cam, 673.0, x)
    chain = local_map(orbit)
    found, error = classify(chain), uncertainty(orbit, chain)
    minus = np.sort(found.multipliers_minus.real)[::-1]
    plus = found.multipliers_plus[np.argmax(found.multipliers_plus.imag)]
    derived = "chain rule, against 40-digit differences of the period in closed form"
    rows = [
        Number(5, "corner impact of O(1, 1) [rpm]", "673.234445", orbit.p, 11, derived),
        Number(5, "multiplier before the corner", "1.0052", float(minus[0]), 11, derived),
        Number(5, "the other", "0.6367", float(minus[1]), 11, derived),
        Number(5, "multipliers after it, real part", "0.6857", float(plus.real), 11, derived),
        Number(5, "and imaginary part", "0.4120", float(plus.imag), 11, derived),
        Number(5, "x*: position on the section [m]", "", float(orbit.x[0]), 12, derived),
        Number(5, "x*: velocity [m/s]", "", float(orbit.x[1]), 10, derived),
        Number(5, "speed at the corner impact [m/s]", "", orbit.before, 10, derived),
    ]
    for name in MATRICES:
        label = name.replace("_minus", "−").replace("_plus", "+")
        rows += entries(label, np.asarray(getattr(chain, name)), error[name], derived)
    form, off = normal_form(chain), carried(chain, error)
    from_these = "from A−, A+, B−, C, D; their errors carried over"
    for label, value, wrong in (
        ("W of the normal form", form.W, off.W),
        ("Ã− of the normal form", form.A_minus, off.A_minus),
        ("Ã+ of the normal form", form.A_plus, off.A_plus),
        ("B̃ of the normal form", form.B, off.B),
        ("border shift of the normal form", form.shift[:1], off.shift[:1]),
    ):
        rows += entries(label, value, float(np.max(wrong)), from_these)
    return rows


def entries(label: str, value: Array, error: float, check: str) -> list[Number]:
    """Every entry of a matrix of chapter 5 with the decimals that its error leaves."""
    value = np.atleast_1d(value)
    places = max(0, min(13, int(-np.log10(2.0 * error)))) if error else 13
    rows = []
    for index in np.ndindex(value.shape):
        entry = "[" + ", ".join(str(i + 1) for i in index) + "]" if value.size > 1 else ""
        rows.append(Number(5, label + entry, "", float(value[index]), places, check))
    return rows


def carried(chain: PiecewiseLinearMap, error: dict[str, float]) -> NormalForm:
    """How far the parts of the normal form may be off where each entry of the local map is off by its error."""
    base = normal_form(chain)
    off = [np.zeros_like(part) for part in base]
    for name in MATRICES:
        value = np.atleast_1d(np.asarray(getattr(chain, name), dtype=float))
        for index in np.ndindex(value.shape):
            moved = value.copy()
            moved[index] += PROBE * error[name]
            entry: Any = float(moved[0]) if name == "D" else moved
            for total, a, b in zip(off, normal_form(replace(chain, **{name: entry})), base, strict=True):
                total += np.abs(a - b) / PROBE
    return NormalForm(*(x + ROUNDING * np.max(np.abs(y)) for x, y in zip(off, base, strict=True)))


def _controller() -> list[Number]:
    scene, constant = hybrid_abs("dry"), hybrid_abs("dry", "constant")
    cycle, other = limit_cycle(scene), limit_cycle(constant)
    slip, top = peak(scene)
    rows = [
        Number(7, "slip at max Ψ", "", slip, 14, "root of dΨ/dλ, 40 digits in mpmath"),
        Number(7, "max Ψ [N m]", "", top, 10, "the same"),
        Number(7, "the cycle vanishes below T_max [N m]", "", vanishing(scene), 9, "bisection; equals max Ψ"),
    ]
    exact = "DOP853 at 1e-12; ramps last 600 N m / k exactly"
    for name, found in (("ω = v (1 − λ)/r", cycle), ("ω = v/r", other)):
        for printed, state, time in zip(SWITCHINGS, found.states[1:], found.times[1:], strict=True):
            what = f"switching to state {state}, after that to state {found.states[0]} [s], {name}"
            rows.append(Number(7, what, printed, float(time), 9, exact))
        for state, duration in zip(found.states, np.diff(np.append(found.times, found.period)), strict=True):
            rows.append(
                Number(7, f"time in state {state} of the cycle [s], {name}", "", float(duration), 9, exact)
            )
    rows += [
        Number(7, "period of the cycle [s], ω = v (1 − λ)/r", "", cycle.period, 12, "DOP853 at 1e-12"),
        Number(7, "period of the cycle [s], ω = v/r", "", other.period, 12, "DOP853 at 1e-12"),
        Number(7, "multiplier", "0.0", cycle.multiplier, 9, "saltation matrices; zero by differences too"),
    ]
    return rows


PARTS = _chattering, _upper, _corner, _controller
