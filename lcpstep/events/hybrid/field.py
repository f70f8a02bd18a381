"""A system with modes as kernels see it: its vector fields, sliding included, its guards and their gradients.

    F_s = (L2 F1 - L1 F2) / (L2 - L1),    L_i = H_t + H_x F_i         (Filippov's convex combination)

Sliding ends where L1 falls to zero (the motion goes on below) or L2 rises to it (above): two guards of the sliding
mode. Gradients are differences of fourth order, exact for linear functions, over lengths in which these are smooth.
"""

from __future__ import annotations

from typing import Any

import cython
import numpy as np

from lcpstep.arrays import doubles, indices
from lcpstep.events.hybrid.kinds import DIFFERENCE, EXIT_ABOVE, EXIT_BELOW, NOT_SLIDING
from lcpstep.kernels.function import Functions
from lcpstep.kernels.roundings import RESOLUTION
from lcpstep.kernels.vectors import copy
from lcpstep.pointers import Doubles, abs, after, inf, max

INNER, OUTER = 2.0 / 3.0, -1.0 / 12.0
# Two difference quotients that differ by no more than this share, or that tell nothing; by how much their lengths are
# cut, how often; the least step of time, in its roundings
SMOOTH, LOST = 1e-6, 1e-2
SHORTER, SHORTENINGS = 0.125, 10
TICKS = 1024.0
TINY = 1e-300  # a band is never empty
VECTORS = 8
SURFACE = -1  # in place of a guard


class Machine:
    """Everything that a kernel needs to evaluate a system with modes, and work space; `machine` makes it.

    n, n_guards      numbers in a state; guards
    fields, surfaces : Functions by mode; H of a sliding mode, whose field is not used
    values, resets : Functions by guard
    first : (modes + 1,)   the guards of mode m are first[m] .. first[m + 1] - 1
    sign, at_once, kind, target, has_reset : by guard
        it acts where sign times its value rises through zero; at once on entering; PLAIN, ..; the mode entered, for
        ARRIVE the sliding one
    below, above     modes beside a sliding one, or NOT_SLIDING
    dt               step of differences in time
    length : (n,)    lengths over which all is smooth, where these are shorter than one;  shortest   of them
    F, F1, F2, H_x, g_x : (n,)   a field; those on both sides; gradients of a surface and of a guard
    x, x_guard : (n,)   shifted states of their differences
    moved : (n,)     state after a reset

    Parameters
    ----------
    n : int;  p : (n_p,)   parameters
    functions : dict   addresses of the functions by name;  tables : dict   the integers
    sign, dt, length   as above;  kept : what must outlive this object
    """

    def __init__(
        self,
        n: int,
        p: Any,
        functions: dict[str, Any],
        tables: dict[str, Any],
        sign: Any,
        dt: float,
        length: Any,
        kept: Any,
    ) -> None:
        own = {name: np.array(table, dtype=np.intp) for name, table in tables.items()}
        self.numbers, self.out_array = np.zeros((VECTORS, n)), np.zeros(1)
        self.signs = np.array(sign, dtype=float)
        self.lengths, self.shortest = np.array(length, dtype=float), float(np.min(length))
        self.length = doubles(self.lengths)
        self.n, self.n_guards, self.dt = n, len(own["kind"]), dt
        self.kept = p, own, kept
        self.fields = Functions(functions["fields"], p, n, 0, (n,))
        self.surfaces = Functions(functions["surfaces"], p, n, 0, (1,))
        self.values = Functions(functions["values"], p, n, 0, (1,))
        self.resets = Functions(functions["resets"], p, n, 0, (n,))
        self.has_reset, self.at_once = indices(own["has_reset"]), indices(own["at_once"])
        self.first = indices(own["first"])
        self.kind, self.target = indices(own["kind"]), indices(own["target"])
        self.below, self.above = indices(own["below"]), indices(own["above"])
        self.sign, self.out, self.F = doubles(self.signs), doubles(self.out_array), doubles(self.numbers)
        self.F1, self.F2 = after(self.F, n), after(self.F, 2 * n)
        self.H_x, self.g_x = after(self.F, 3 * n), after(self.F, 4 * n)
        self.x, self.x_guard = after(self.F, 5 * n), after(self.F, 6 * n)
        self.moved = after(self.F, 7 * n)

    def rates_at(self, mode: int, t: float, x: Any) -> Any:
        """The vector field of a mode, (n,)."""
        x, out = np.array(x, dtype=float), np.zeros(self.n)
        field(self, mode, t, doubles(x), doubles(out))
        return out

    def surface_at(self, mode: int, t: float, x: Any) -> tuple[float, float, float]:
        """H, L1 and L2 of a sliding mode."""
        x = np.array(x, dtype=float)
        L1, L2 = approaches(self, mode, t, doubles(x))
        return scalar(self, self.surfaces, mode, t, doubles(x)), L1, L2

    def guard_slope_at(self, mode: int, k: int, t: float, x: Any) -> tuple[Any, float]:
        """Derivatives of guard k of a mode by the state (n,) and by time."""
        x = np.array(x, dtype=float)
        g_t = guard_gradient(self, mode, k, t, doubles(x))
        return self.numbers[4].copy(), g_t

    @cython.ccall
    def target_of(self, k: int) -> int:
        """The mode that guard k leads to."""
        return self.target[k]


def reach(m: Machine, i: int, x_i: float) -> float:
    """The length of which differences by state i are a share."""
    return m.length[i] if m.length[i] < 1.0 else max(1.0, abs(x_i))


def scalar(m: Machine, f: Functions, k: int, t: float, x: Doubles) -> float:
    """Value of function k of those with one result."""
    f.fill(k, t, x, x, m.out)
    return m.out[0]


def field(m: Machine, mode: int, t: float, x: Doubles, out: Doubles) -> None:
    """The vector field of a mode."""
    if m.below[mode] == NOT_SLIDING:
        m.fields.fill(mode, t, x, x, out)
        return
    L1, L2 = approaches(m, mode, t, x)
    for i in range(m.n):
        out[i] = (L2 * m.F1[i] - L1 * m.F2[i]) / (L2 - L1)


def approaches(m: Machine, mode: int, t: float, x: Doubles) -> tuple[float, float]:
    """L1 and L2 of a sliding mode, the rates of H along the fields on both sides, which are left in F1 and F2."""
    m.fields.fill(m.below[mode], t, x, x, m.F1)
    m.fields.fill(m.above[mode], t, x, x, m.F2)
    H_t = surface_gradient(m, mode, t, x)
    L1, L2 = H_t, H_t
    for i in range(m.n):
        L1 += m.H_x[i] * m.F1[i]
        L2 += m.H_x[i] * m.F2[i]
    return L1, L2


def surface_gradient(m: Machine, mode: int, t: float, x: Doubles) -> float:
    """H_x into the work space; returns H_t."""
    return gradient(m, mode, SURFACE, t, x, m.x, m.H_x)


def guard(m: Machine, mode: int, k: int, t: float, x: Doubles) -> float:
    """Value of guard k of a mode; it acts where this rises through zero."""
    if m.kind[k] == EXIT_BELOW:
        return -approaches(m, mode, t, x)[0]
    if m.kind[k] == EXIT_ABOVE:
        return approaches(m, mode, t, x)[1]
    return m.sign[k] * scalar(m, m.values, k, t, x)


def guard_gradient(m: Machine, mode: int, k: int, t: float, x: Doubles) -> float:
    """Gradient of guard k by the state into the work space; returns its derivative by time."""
    return gradient(m, mode, k, t, x, m.x_guard, m.g_x)


def watched(m: Machine, mode: int, k: int, t: float, x: Doubles) -> float:
    """Value of guard k of a mode, or (SURFACE) H of a sliding one."""
    return scalar(m, m.surfaces, mode, t, x) if k == SURFACE else guard(m, mode, k, t, x)


def gradient(m: Machine, mode: int, k: int, t: float, x: Doubles, beside: Doubles, slopes: Doubles) -> float:
    """Its derivatives by the state into `slopes`; returns that by time. beside : (n,)  work space."""
    copy(beside, x, m.n)
    for i in range(m.n):
        slopes[i] = slope(m, mode, k, t, x, i, beside)
    return slope(m, mode, k, t, x, m.n, beside)


def slope(m: Machine, mode: int, k: int, t: float, x: Doubles, i: int, beside: Doubles) -> float:
    """Its derivative by state i, or by time (i = n). beside : (n,)   x, and so again.

    The length of a motion tells nothing of that over which a function bends: an angle grows for ever, and a surface
    may move for a short part of a span. Where quotients over d and 2 d differ, those over shorter ones are taken; at
    a kink, where all do, the mean over the longest.
    """
    d, shortest = max(m.dt, TICKS * RESOLUTION * abs(t)), 0.0
    if i < m.n:
        d, shortest = DIFFERENCE * reach(m, i, x[i]), DIFFERENCE * DIFFERENCE * m.length[i]
    first, best, least = 0.0, 0.0, inf
    for cut in range(SHORTENINGS):
        near = quotient(m, mode, k, t, x, i, beside, d)
        far = quotient(m, mode, k, t, x, i, beside, 2.0 * d)
        found = 2.0 * INNER * near + 4.0 * OUTER * far
        unlike, size = abs(far - near), max(abs(near), abs(far))
        if not unlike > SMOOTH * size:
            return found
        first = found if cut == 0 else first
        if unlike < least * size:
            best, least = found, unlike / size
        elif least <= LOST:  # rounding by now
            break
        d *= SHORTER
        if d < shortest:
            break
    return best if least <= LOST else first


def quotient(m: Machine, mode: int, k: int, t: float, x: Doubles, i: int, beside: Doubles, d: float) -> float:
    """Difference quotient over d before and after x in state i, or time (i = n)."""
    if i == m.n:
        later, earlier = t + d, t - d
        up, down = watched(m, mode, k, later, beside), watched(m, mode, k, earlier, beside)
    else:
        later, earlier = x[i] + d, x[i] - d
        beside[i] = later
        up = watched(m, mode, k, t, beside)
        beside[i] = earlier
        down = watched(m, mode, k, t, beside)
        beside[i] = x[i]
    return (up - down) / (later - earlier)


def band_and_rate(
    m: Machine, mode: int, k: int, t: float, x: Doubles, rtol: float, atol: float
) -> tuple[float, float, float]:
    """How well guard k is known under these tolerances; its rate along the motion, and how well that is known.

    The rate of the state is in F.
    """
    g_t = guard_gradient(m, mode, k, t, x)
    rate, band, size = g_t, TINY + abs(g_t) * 16.0 * RESOLUTION * abs(t), abs(g_t)
    for i in range(m.n):
        rate += m.g_x[i] * m.F[i]
        size += abs(m.g_x[i] * m.F[i])
        band += abs(m.g_x[i]) * (atol + (rtol + 16.0 * RESOLUTION) * abs(x[i]))
    band += 16.0 * RESOLUTION * abs(t) * abs(rate)
    if m.kind[k] >= EXIT_BELOW:  # made of differences itself
        L1, L2 = approaches(m, mode, t, x)
        band += atol + rtol * (abs(L1) + abs(L2))
    return band, rate, 64.0 * RESOLUTION * size


def project(m: Machine, mode: int, t: float, x: Doubles) -> None:
    """The nearest state on the surface of a sliding mode, by one Newton step."""
    surface_gradient(m, mode, t, x)
    H, square = scalar(m, m.surfaces, mode, t, x), 0.0
    for i in range(m.n):
        square += m.H_x[i] * m.H_x[i]
    if square > 0.0:
        for i in range(m.n):
            x[i] -= m.H_x[i] * H / square
