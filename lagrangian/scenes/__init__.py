"""Scenes ready to use, each a function of its parameters, and their catalogue by name."""

from __future__ import annotations

from collections.abc import Callable

from lagrangian.scene import Scene
from lagrangian.scenes.bouncing_ball import bouncing_ball
from lagrangian.scenes.cam_follower import cam_follower
from lagrangian.scenes.impact_oscillator import impact_oscillator

CATALOGUE: dict[str, Callable[..., Scene]] = {
    "bouncing-ball": bouncing_ball,
    "cam-follower": cam_follower,
    "impact-oscillator": impact_oscillator,
}

__all__ = ["CATALOGUE", "bouncing_ball", "cam_follower", "impact_oscillator"]
