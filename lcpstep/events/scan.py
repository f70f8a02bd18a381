"""How finely the motion between events must be looked at: the scan for events must see every turn of it."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from lagrangian import Scene
from lcpstep.callbacks.faults import cause, forget
from lcpstep.kernels.function import Function
from lcpstep.kernels.model import Model
from lcpstep.turns import turns
from lcpstep.turns.source import GOLDEN

Array = NDArray[np.float64]
# Intervals per period of each oscillation, of the forcing, of the span
PER_PERIOD, PER_FORCING, PER_SPAN = 10, 16, 50
SAMPLES, WINDOWS = 512, 16  # of the motion of obstacles, to see how fast it turns
# Irregular: no oscillation hides between them
PLACES = np.arange(SAMPLES) + np.arange(SAMPLES) * GOLDEN % 1.0
SLOPE = 1e-7  # of the time looked at: step of a difference


class Seen(NamedTuple):
    """Samples of what moves by itself: places, speeds and accelerations of obstacles and frame, (times, n, 3)."""

    times: Array
    motion: Array | None
    frame: Array | None


def seen(scene: Scene, m: Model) -> Seen:
    """Samples of what moves by itself in a scene; None of what does not."""
    times = np.asarray(scene.t_span[0] + sampled_length(scene) * PLACES / SAMPLES)
    parts = (m.motion, scene.n_c), (m.frame, scene.n_q)
    return Seen(times, *(samples_of(scene, f, n, times) if f.given else None for f, n in parts))


def samples_of(scene: Scene, f: Function, n: int, times: Array) -> Array:
    """Samples (times, n, 3) of a function of time; zero where there is none."""
    out = np.zeros((len(times), n, 3))
    if f.given:
        sampled(f, times, np.array(scene.q0), np.array(scene.v0), out)
    return out


def scan_interval(scene: Scene, m: Model, rate: float, samples: Seen | None = None) -> float:
    """Longest interval on which the gap acceleration may be taken to change its sign only once.

    At least one between two neighbouring numbers, in spans of a few of them.

    rate : fastest rate of the free motion [rad/s], 0 where it is not known
    samples : of what moves by itself, where they have been taken
    """
    scan = min((scene.t_span[1] - scene.t_span[0]) / PER_SPAN, scene.period / PER_FORCING)
    if rate > 0.0:
        scan = min(scan, 2.0 * math.pi / PER_PERIOD / rate)
    turn = fastest_turn(scene, m, samples)
    # A period that is given says how finely to look, unless what moves is much faster.
    if turn < (2.0 * scan if math.isfinite(scene.period) else math.inf):
        scan = min(scan, turn / PER_FORCING)
    return max(scan, math.ulp(scene.t_span[0]), math.ulp(scene.t_span[1]))


def fastest_turn(scene: Scene, m: Model, samples: Seen | None) -> float:
    """Time of the fastest turn of what moves by itself, obstacle or frame [s]; infinite where nothing does.

    2 pi max |s'| / max |s''| of samples, which need not be dense for that; what has no period may speed up, and is
    looked at in windows of time. Stretches that turn fast by themselves are left out: runs stop there
    (`lcpstep.turns`).
    """
    if not (m.motion.given or m.frame.given or m.gap_t.given):
        return math.inf
    windows = 1 if math.isfinite(scene.period) else WINDOWS
    fastest = 0.0
    samples = samples or seen(scene, m)
    even = turns(scene).elsewhere(samples.times, scene.period)
    for rates in _rates(scene, m, samples, SLOPE * sampled_length(scene)):
        size = np.abs(rates.T, order="C")  # times last: maxima over what lies side by side
        size[..., ~even] = 0.0
        speed, acceleration = size.reshape(2, rates.shape[1], windows, -1).max(axis=-1)
        turning = (speed > 0.0) & np.isfinite(acceleration / np.where(speed > 0.0, speed, 1.0))
        fastest = max(fastest, np.max(acceleration[turning] / speed[turning], initial=0.0))
    return 2.0 * math.pi / fastest if fastest > 0.0 else math.inf


def sampled_length(scene: Scene) -> float:
    """How much of the motion of what moves by itself is looked at: a period, or the whole span [s]."""
    return min(scene.period, scene.t_span[1] - scene.t_span[0])


def _rates(scene: Scene, m: Model, samples: Seen, step: float) -> Iterator[Array]:
    """Speeds and accelerations of each frame and obstacle that moves by itself, at these times, (times, n, 2)."""
    for found in (samples.motion, samples.frame):
        if found is not None:
            yield found[:, :, 1:]
    if m.gap_t.given:
        times, state = samples.times, (np.array(scene.q0), np.array(scene.v0))
        now, then = np.zeros((2, len(times), scene.n_c))
        for out, t in ((now, times), (then, times + step)):
            sampled(m.gap_t, t, *state, out)
        yield np.stack([now, (then - now) / step], axis=2)


def sampled(f: Function, times: Array, q: Array, v: Array, out: Array) -> None:
    """A function at many times of one state. The motion may never come there: what it raises does not count."""
    f.sample(times, q, v, out)
    cause()  # but for the keyboard
    forget()
