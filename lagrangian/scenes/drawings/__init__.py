"""How the ready scenes look: functions of time and coordinates, with sizes from the parameters of each scene."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from typing import Any

import numpy as np

from lagrangian.drawing import Drawing
from lagrangian.scenes.drawings.balls import ball, ball_on_kinked, ball_on_sine, beads, in_bowl
from lagrangian.scenes.drawings.blocks import (
    blocks,
    chain,
    feet,
    on_belt,
    on_slope,
    on_swaying,
    rocking,
    sprung,
    stacked,
    two_springs,
)
from lagrangian.scenes.drawings.common import Shapes
from lagrangian.scenes.drawings.mechanisms import (
    cam,
    crank,
    leaning_rod,
    links,
    pecking,
    pendulum,
    two_rods,
    wheel,
)


def _size(scene: Any) -> float:
    return max(1e-3, *(abs(float(x)) for x in np.ravel(scene.q0)))


def _walls(scene: Any) -> tuple[float, ...]:
    return (float(scene.parameters["width"]),) if "width" in scene.parameters else ()


def _table(draw: Callable[..., Shapes]) -> Callable[[Any, Any], Drawing]:
    return lambda scene, p: partial(draw, p=scene.p, size=max(2.0 * _size(scene), 0.05))


def _sprung(scene: Any, p: Any) -> Drawing:
    return partial(sprung, stop=p["stop"], size=max(abs(p["amplitude"]), abs(p["q0"]), abs(p["stop"])))


def _beads(upright: bool, floor: bool) -> Callable[[Any, Any], Drawing]:
    def make(scene: Any, p: Any) -> Drawing:
        r = 0.25 * float(np.ptp(scene.q0) or 1.0) / scene.n_q
        return partial(beads, r=r, upright=upright, walls=_walls(scene), floor=floor)

    return make


# By name: how the scene's drawing is made from the scene and its parameters
MAKERS: dict[str, Callable[[Any, Any], Drawing]] = {
    **dict.fromkeys(
        ("bouncing-ball", "dyadic-ball", "elastic-ball", "grazing"), lambda s, p: partial(ball, size=_size(s))
    ),
    **dict.fromkeys(("ball-on-table", "chattering-table"), _table(ball_on_sine)),
    "jumping-table": lambda s, p: partial(ball_on_kinked, p=s.p, size=max(2.0 * _size(s), 0.3)),
    **dict.fromkeys(("impact-oscillator", "sticking-oscillator", "chaotic-oscillator"), _sprung),
    "pendulum-stop": lambda s, p: partial(pendulum, length=p["length"]),
    "double-pendulum": lambda s, p: partial(two_rods, points=p["form"] == "rods", wall=p["wall"]),
    "kane-pendulum": lambda s, p: partial(two_rods, points=False, floor=float(s.p[1])),
    "bowl": lambda s, p: partial(in_bowl, radius=p["radius"]),
    "elastic-gas": _beads(upright=False, floor=True),
    "falling-gas": _beads(upright=True, floor=True),
    "column": _beads(upright=True, floor=True),
    "newtons-cradle": _beads(upright=False, floor=False),
    "inelastic-collapse": _beads(upright=False, floor=False),
    "galperin": lambda s, p: partial(blocks, sides=(0.2, 0.2 + 0.2 * p["k"]), upright=False),
    "heavy-on-light": lambda s, p: partial(blocks, sides=(0.3, 1.0), upright=True),
    "block-on-feet": lambda s, p: partial(feet, n=p["n"], width=p["width"]),
    "stack": lambda s, p: partial(stacked, n=p["n"]),
    "elastic-chain": lambda s, p: partial(chain, distance=p["distance"]),
    "rocking-block": lambda s, p: partial(rocking, b=p["b"], h=p["h"]),
    "coulomb-oscillator": lambda s, p: partial(on_belt, size=abs(p["x0"]) or 1.0, contacts=(0,)),
    "mass-on-belt": lambda s, p: partial(on_swaying, p=s.p, size=1.0),
    "stick-slip-belt": lambda s, p: partial(on_swaying, p=s.p, size=max(1.0, p["mu_s"])),
    "mass-on-shaken-belt": lambda s, p: partial(on_swaying, p=s.p, size=1.0),
    "superball": lambda s, p: partial(
        wheel, radius=p["radius"], reach=abs(p["v0"]) * s.t_span[1] + p["radius"]
    ),
    "sliding-rocking-block": lambda s, p: partial(rocking, b=p["b"], h=p["h"]),
    "slipping-wheel": lambda s, p: partial(
        wheel, radius=p["radius"], reach=p["v0"] * s.t_span[1] + p["radius"]
    ),
    "sliding-block": lambda s, p: partial(
        on_slope, slope=0.0, size=0.2, reach=p["v0"] ** 2 / (p["mu"] * p["g"])
    ),
    "slope-landing": lambda s, p: partial(on_slope, slope=p["slope"], size=0.2, reach=p["v0"] * s.t_span[1]),
    "slider-crank": lambda s, p: partial(crank, p=s.p),
    "woodpecker": lambda s, p: partial(pecking, height=0.05),
    "hinged-chain": lambda s, p: partial(
        links, left=-p["link"], right=(p["n"] + 1) * p["link"] + max(0.0, p["speed"]) * s.t_span[1]
    ),
    "falling-rod": lambda s, p: partial(leaning_rod, half=s.p[0], reach=1.5),
    "cam-follower": lambda s, p: partial(cam, p=s.p, relative=p["coordinates"] == "relative"),
    **dict.fromkeys(
        ("bilinear-oscillator", "driven-bilinear-oscillator"), lambda s, p: partial(two_springs, size=1.5)
    ),
    "dry-friction-oscillator": lambda s, p: partial(on_belt, size=1.0),
    "stick-slip-oscillator": lambda s, p: partial(on_belt, size=1.0, belt=p["belt"]),
}


def drawing_of(scene: Any) -> Drawing | None:
    """The drawing of a ready scene; None for one that has no shape, as a controller."""
    make = MAKERS.get(scene.name)
    return None if make is None else make(scene, scene.parameters)
