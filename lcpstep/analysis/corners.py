"""Corner impacts: where an impact of a periodic orbit meets a corner of the forcing, and the map around it.

With y the state (q, v) at the time t_c of the corner, as it would be there without the impact, a period of the
forcing is composed of three maps of the state and the parameter p,

    x -> y = F1(x, p)  to the corner,      y -> Z(y, p)  the impact,      -> F2(Z, p)  to the next section

where Z, the discontinuity map, takes no time: along the free flow to the surface H(y, p) = g(t_c, q) = 0, the impact
law R there, and back along the flow to t_c. On the side H < 0 the impact came before the corner and the flows are
those of the accelerations before it (Z-), on the side H > 0 of those after it (Z+):

    Z_y = R_y + (F+ - R_y F- - R_t) H_y / u-,      Z_p = R_p + (F+ - R_y F- - R_t) H_p / u-        on either side
    Z+_y - Z-_y = E H_y,   Z+_p - Z-_p = E H_p                           the corner correction, of rank one
    A = F2_y Z_y F1_x,   B = F2_y (Z_y F1_p + Z_p) + F2_p,   C = H_y F1_x,   D = H_y F1_p + H_p

so the impact falls before the corner where C dx + D dp < 0. R_p and H_p are derivatives at the corner as it moves
with the parameter. Source: G. Osorio, Complex Behavior in Impacting Systems, chapters 5 and 6 (eqs. 5.14-5.25 and
6.16-6.50); derived anew here, and checked by differences, for the printed forms contain sign errors.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import partial

import numpy as np
from numpy.typing import ArrayLike, NDArray

from lagrangian import checks
from lcpstep.analysis.border_collision import PiecewiseLinearMap
from lcpstep.analysis.corner_pieces import CornerImpact as CornerImpact
from lcpstep.analysis.corner_pieces import Family, Pieces
from lcpstep.analysis.corner_pieces import NotDifferentiable as NotDifferentiable
from lcpstep.analysis.derivative import EIGHTH, differences, one_sided
from lcpstep.analysis.variation import flow, impact_law
from lcpstep.errors import LcpStepError
from lcpstep.events import EventDriven
from lcpstep.maps.local import Local
from lcpstep.pace import counted

Array = NDArray[np.float64]
LIMIT = 1e-6  # of the period: steps of the extrapolation to a corner from either side
WIDE, NARROW = 4e-3, 2e-4  # steps of differences, relative: of free motion, and where there are other impacts
MAX_ITERATIONS = 30
STAGNATED = 1e-8


def corner_impact(
    make: Family,
    p: float,
    x: ArrayLike,
    *,
    corner: int | None = None,
    n: int = 1,
    phase: float = 0.0,
    method: EventDriven | None = None,
) -> CornerImpact:
    """The parameter and the periodic orbit at which an impact falls on a corner, by Newton's method.

    Parameters
    ----------
    make : p -> scene with one contact, a period and corners
    p, x : guess of the parameter and of the state (q, v) on the section, for example from `periodic_orbit`
    corner : index in scene.corners; where not given, the one nearest to an impact of the guess
    n : periods after which the orbit repeats
    phase : of the section, as a share of the period; no impact of the orbit may lie on it

    Raises
    ------
    ValueError   a scene without corners, an unknown corner, a guess without impacts
    NotDifferentiable   a corner of degree one (velocity jump), or an orbit with grazing or sticking
    LcpStepError   no such orbit near the guess
    """
    checks.function("make", make, "the parameter that makes a scene")
    scene = make(checks.number("p", p))
    if np.size(scene.corners) == 0 or scene.n_c != 1 or not math.isfinite(scene.period):
        raise ValueError(
            f"make: expected scenes with one contact, a period and corners, {scene.name!r} has not all"
        )
    x = np.array(checks.array("x", x, (2 * scene.n_q,)))
    pieces = Pieces(make, method or EventDriven(), phase, checks.count("n", n))
    pieces.aim(p, x, corner)
    z: Array = np.append(x, p)
    scale = pieces.scales(x, p)
    size = np.append(scale[:-1], np.max(scale[: len(x) // 2]))  # of the way round, and of the gap
    before, best = math.inf, z
    for _ in counted(range(MAX_ITERATIONS)):
        F = pieces.closing(z)
        error = float(np.max(np.abs(F) / size))
        if error >= 0.5 * before and before <= STAGNATED:  # down to its rounding
            return pieces.described(best, before)
        if not error < 10.0 * before:
            break
        before, best = error, z
        z = z - np.linalg.solve(differences(pieces.closing, z, scale=scale), F)
    raise LcpStepError(
        f"no periodic orbit with an impact at corner {pieces.corner} near p = {p:.9g}: residual {error:.3g}"
    )


@dataclass(frozen=True, eq=False)
class DiscontinuityMap:
    """The impact as a map of the state at the corner that takes no time, to first order.

    Attributes
    ----------
    y, image : (2 n_q,)   state at the corner before and after the impact
    minus_y, plus_y : (2 n_q, 2 n_q)   derivatives by the state, for the impact before and after the corner
    minus_p, plus_p : (2 n_q,)   derivatives by the parameter
    H_y, H_p : (2 n_q,) and number   derivatives of the gap at the corner
    """

    y: Array
    image: Array
    minus_y: Array
    plus_y: Array
    minus_p: Array
    plus_p: Array
    H_y: Array
    H_p: float

    @property
    def correction(self) -> tuple[Array, Array]:
        """The corner correction: what is added to (minus_y, minus_p) when the impact moves behind the corner."""
        return self.plus_y - self.minus_y, self.plus_p - self.minus_p


def discontinuity_map(orbit: CornerImpact, method: EventDriven | None = None) -> DiscontinuityMap:
    """The discontinuity map of a corner impact with its derivatives on both sides; see the head of the file."""
    pieces = Pieces.of(orbit, method or EventDriven())
    y = pieces.to_corner(orbit.x, orbit.p)
    n, p = len(y) // 2, orbit.p
    scene = orbit.scene
    local, t = Local(scene), pieces.corner_time(p)
    q, v = y[:n], y[n:]
    image = np.concatenate([q, local.after_impact(t, q, v)])
    G, u = local.rates(t, q, v)
    H_y = np.concatenate([G, np.zeros(n)])
    of_p = partial(differences, x=[p], step=WIDE, stencil=EIGHTH, scale=pieces.scales(orbit.x, p)[-1:])
    H_p = float(of_p(lambda s: pieces.gap(y, float(s[0])))[0, 0])
    R_p = of_p(lambda s: pieces.rebound(y, float(s[0])))[:, 0]
    R_y, _ = impact_law(local, t, q, v)

    def surplus(at: float) -> Array:
        """(F+ - R_y F- - R_t) / u- with the accelerations of the time `at`."""
        _, R_t = impact_law(local, at, q, v)
        F_before = np.concatenate([v, local.acceleration(at, q, v)])
        F_after = np.concatenate([image[n:], local.acceleration(at, q, image[n:])])
        return np.asarray((F_after - R_y @ F_before - R_t) / u)

    found = []
    for side in (-1.0, 1.0):
        limit = one_sided(surplus, t, side * min(LIMIT * scene.period, 0.1 * pieces.clear(scene)))
        found.append((R_y + np.outer(limit, H_y), R_p + limit * H_p))
    (minus_y, minus_p), (plus_y, plus_p) = found
    return DiscontinuityMap(y, image, minus_y, plus_y, minus_p, plus_p, H_y, H_p)


def local_map(
    orbit: CornerImpact, method: EventDriven | None = None, *, step: float | None = None
) -> PiecewiseLinearMap:
    """The piecewise-linear map around a corner impact by the chain rule, in x - orbit.x and p - orbit.p.

    step : of the differences that the flows to the corner and on are derived with, relative to state and parameter;
        4e-3 where not given, or 2e-4 where the orbit has other impacts. Another step tells what is rounding.
    """
    checks.instance("orbit", orbit, CornerImpact)
    step = step or (NARROW if len(orbit.others) else WIDE)
    pieces = Pieces.of(orbit, method or EventDriven())
    Z = discontinuity_map(orbit, method)
    d = len(orbit.x)

    def first(z: Array) -> Array:
        return pieces.to_corner(z[:d], float(z[d]))

    def second(z: Array) -> Array:
        return pieces.from_corner(z[:d], float(z[d]))

    scale = pieces.scales(orbit.x, orbit.p)
    F1 = differences(first, np.append(orbit.x, orbit.p), step, EIGHTH, scale)
    F2 = differences(second, np.append(Z.image, orbit.p), step, EIGHTH, scale)
    F1_x, F1_p, F2_y, F2_p = F1[:, :d], F1[:, d], F2[:, :d], F2[:, d]
    if (
        not len(orbit.others) and Local(orbit.scene).model.linear
    ):  # the flow of a linear system is known exactly
        at = pieces.corner_time(orbit.p)
        start, end = (share * orbit.scene.period for share in (pieces.phase, pieces.phase + pieces.n))
        F1_x, F2_y = flow(orbit.scene, at - start), flow(orbit.scene, end - at)
    return PiecewiseLinearMap(
        A_minus=F2_y @ Z.minus_y @ F1_x,
        A_plus=F2_y @ Z.plus_y @ F1_x,
        B_minus=F2_y @ (Z.minus_y @ F1_p + Z.minus_p) + F2_p,
        B_plus=F2_y @ (Z.plus_y @ F1_p + Z.plus_p) + F2_p,
        C=Z.H_y @ F1_x,
        D=float(Z.H_y @ F1_p) + Z.H_p,
    )
