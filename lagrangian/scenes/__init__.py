"""Scenes ready to use, each a function of its parameters, and their catalogue by name."""

from __future__ import annotations

from lagrangian.scenes.bouncing_ball import bouncing_ball
from lagrangian.scenes.cam_follower import cam_follower
from lagrangian.scenes.catalogue import Entry
from lagrangian.scenes.impact_oscillator import impact_oscillator

CATALOGUE: dict[str, Entry] = {
    "bouncing-ball": Entry(
        bouncing_ball,
        hazard="an event-driven run stalls at the accumulation of impacts, or the ball tunnels through the floor",
        answer="parabolas of geometrically falling duration; at rest from sqrt(2 h0/g) (1 + r)/(1 - r) on",
    ),
    "cam-follower": Entry(
        cam_follower,
        hazard="chattering, sticking, and release at a corner of the cam",
        answer="detachment at the flank-nose corner from 114.979 rpm on, at the end of the nose from 134.873 rpm on",
    ),
    "impact-oscillator": Entry(
        impact_oscillator,
        hazard="time-stepping is of order one however smooth the motion in between",
        answer="the flow between impacts in closed form",
    ),
}

__all__ = ["CATALOGUE", "Entry", "bouncing_ball", "cam_follower", "impact_oscillator"]
