"""The local map around a corner impact from simulated perturbations: a check of the chain rule."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from lcpstep.analysis.border_collision import PiecewiseLinearMap
from lcpstep.analysis.corner_pieces import CornerImpact
from lcpstep.events import EventDriven
from lcpstep.maps.stroboscopic import StroboscopicMap
from lcpstep.pace import counted

Array = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class Estimate:
    """The local map from simulated perturbations.

    Attributes
    ----------
    map : PiecewiseLinearMap   C and D are those of the chain rule: a fit knows the sides only by where points fell
    rms : (minus, plus)   residual of the fit, relative to the deviations' images
    points : (minus, plus)   how many perturbations fell on each side
    """

    map: PiecewiseLinearMap
    rms: tuple[float, float]
    points: tuple[int, int]


def estimate(
    orbit: CornerImpact,
    border: PiecewiseLinearMap,
    *,
    size: float = 1e-3,
    samples: int = 60,
    seed: int = 0,
    method: EventDriven | None = None,
) -> Estimate:
    """A and B by least squares on perturbations of the event-driven run, quadratic terms fitted along.

    Parameters
    ----------
    orbit, border : the corner impact, and a map whose C and D say on which side a perturbation falls
    size : of the perturbations: relative to the state and the parameter
    samples : perturbations on each side
    seed : of their random directions

    Raises
    ------
    LcpStepError   too few perturbations fell on one side
    """
    rng = np.random.default_rng(seed)
    d = len(orbit.x)
    scale = size * np.append(np.maximum(np.abs(orbit.x), np.max(np.abs(orbit.x)) * 1e-2), abs(orbit.p))
    C, D = np.asarray(border.C), border.D
    # Deviations are balanced so that the border cuts them through the middle.
    weights = np.abs(np.append(C, D)) * scale
    least = float(np.min(weights[weights > 0.0]))
    scale = scale * np.minimum(1.0, least / np.maximum(weights, least))
    fits, rms, counts = [], [], []
    for side in counted((-1.0, 1.0)):
        deviations: list[Array] = []
        while len(deviations) < samples:
            z = scale * rng.uniform(-1.0, 1.0, d + 1)
            place = float(C @ z[:d] + D * z[d])
            deviations.append(z if place * side > 0.0 else -z)
        Z = np.array(deviations)
        images = np.array([_image(orbit, z, method or EventDriven()) for z in counted(list(Z))])
        terms = Z / scale
        squares = [terms[:, i] * terms[:, j] for i in range(d + 1) for j in range(i, d + 1)]
        cubes = [squares[k] * terms[:, i] for k in range(len(squares)) for i in range(d + 1)]
        M = np.column_stack([terms, *squares, *cubes])
        solution = np.linalg.lstsq(M, images, rcond=1e-13)[0]
        left = images - M @ solution
        rms.append(float(np.sqrt(np.mean(left**2)) / np.sqrt(np.mean(images**2))))
        fits.append((solution[: d + 1] / scale[:, None]).T)
        counts.append(samples)
    found = PiecewiseLinearMap(
        fits[0][:, :d], fits[1][:, :d], fits[0][:, d], fits[1][:, d], border.C, border.D
    )
    return Estimate(found, (rms[0], rms[1]), (counts[0], counts[1]))


def _image(orbit: CornerImpact, z: Array, method: EventDriven) -> Array:
    """Deviation from the orbit after its periods of the motion that starts with the deviation z = (dx, dp)."""
    P = StroboscopicMap(orbit.make(orbit.p + float(z[-1])), method, orbit.phase)
    return np.asarray(P.follow(orbit.x + z[:-1], orbit.periods).states[0, -1] - orbit.x)


def agreement(one: PiecewiseLinearMap, other: PiecewiseLinearMap) -> float:
    """Largest difference of the matrices of two maps, relative to the largest entry of each."""
    worst = 0.0
    for name in ("A_minus", "A_plus", "B_minus", "B_plus"):
        a, b = np.asarray(getattr(one, name)), np.asarray(getattr(other, name))
        worst = max(worst, float(np.max(np.abs(a - b)) / np.max(np.abs(b))))
    return worst
