"""How far an obstacle and a frame that move by themselves can reach, from samples of a period.

With c the displacement of the frame and s that of the obstacle, the gap offset + G (y - c) - s of the absolute
position y is open while

    G y > max over a period of (G c + s) - offset

and its acceleration is G y'' less at most max |G c'' + s''|. Corners split a period into smooth pieces, and every
piece is looked at, however short. Where the speed jumps up at a corner, no acceleration tells what is reached then.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from lagrangian import Scene
from lcpstep.events.scan import SAMPLES, Seen, sampled_length, samples_of, seen
from lcpstep.kernels.model import Model
from lcpstep.turns import turns

Array = NDArray[np.float64]
PER_PIECE = 8  # samples between two corners
AGAIN = 16  # every so many samples, is the motion the same a period later?
SAME = 1e-9  # relative
BESIDE = 1e-11  # a corner, relative to time and period
JUMP = 1e-9  # of the speed there, relative to the largest
STEEPER, HARDER = 2.0, 1.25  # than in the samples: speeds and accelerations between them


class Reach(NamedTuple):
    """What is known of a moving obstacle."""

    clear: float  # the position above; infinite where nothing moves, and where the motion does not repeat
    bend: float  # the acceleration above
    size: float  # largest displacement
    speed: float  # largest velocity


def reach(scene: Scene, m: Model, all_seen: Seen | None = None) -> Reach:
    """The bounds above, and the size of the motion that is seen; `all_seen` where samples have been taken."""
    G, offset = float(m.arrays["G"][0, 0]), float(m.arrays["offset"][0])
    if not m.frame.given and not m.motion.given:
        return Reach(math.inf, 0.0, 0.0, 0.0)

    def samples(times: Array) -> Array:
        frame, motion = (samples_of(scene, f, 1, times) for f in (m.frame, m.motion))
        return np.asarray((G * frame + motion)[:, 0])

    regular, motion, frame = all_seen or seen(scene, m)
    still = np.zeros((1, 1, 3))
    at_regular = (G * (still if frame is None else frame) + (still if motion is None else motion))[:, 0]
    found = np.concatenate([at_regular, samples(_between_corners(scene))])
    size = np.max(np.abs(found.T, order="C"), axis=1)
    far = Reach(math.inf, 0.0, float(size[0]), float(size[1]))
    if not math.isfinite(scene.period):
        return far
    late = regular[::AGAIN] + scene.period
    late = late[late <= scene.t_span[1]]
    again = np.abs(samples(late) - found[:SAMPLES:AGAIN][: len(late)])
    if not np.all(np.isfinite(size)) or np.any(again[:, :2] > SAME * size[:2]):
        return far
    before, after = (samples(_beside_corners(scene, side))[:, 1] for side in (-BESIDE, BESIDE))
    if np.any(after - before > JUMP * size[1]):
        return far
    spacing = sampled_length(scene) / SAMPLES
    clear = float(np.max(found[:, 0]) + STEEPER * spacing * size[1] - offset)
    return far._replace(clear=clear, bend=float(HARDER * size[2]))


def _beside_corners(scene: Scene, side: float) -> Array:
    """Times beside every corner that the span meets first in a period, by a share of the period."""
    start = scene.period * math.floor(scene.t_span[0] / scene.period)
    times = start + np.append(turns(scene).stops, turns(scene).stops + scene.period)
    met = times[(times > scene.t_span[0]) & (times < scene.t_span[1])]
    return np.asarray(met + side * np.maximum(scene.period, np.abs(met)))


def _between_corners(scene: Scene) -> Array:
    """Times inside of every smooth piece of the period at the start of the span."""
    corners = turns(scene).stops
    if len(corners) == 0 or not math.isfinite(scene.period):
        return np.zeros(0)
    start = scene.period * math.floor(scene.t_span[0] / scene.period)
    ends = start + np.append(corners, corners[0] + scene.period)
    share = (np.arange(PER_PIECE) + 0.5) / PER_PIECE
    times = (ends[:-1, None] + np.diff(ends)[:, None] * share).ravel()
    return np.asarray(times[(times >= scene.t_span[0]) & (times <= scene.t_span[1])])
