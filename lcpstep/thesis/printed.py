"""What is known to us of the figures of the thesis itself: what each shows, with the numbers it names.

The pictures are its author's and are not copied. Source: G. Osorio, Complex Behavior in Impacting Systems.
"""

from __future__ import annotations

PRINTED: dict[str, str] = {
    "2": ("normal forms of the codimension-one bifurcations of smooth maps, as schemes."),
    "3.2": (
        "lift, velocity and acceleration of the cam of circular arcs: the acceleration jumps at six corners."
    ),
    "3.3": ("profiles of other smoothness, a discontinuity in the first, second or third derivative."),
    "3.4": (
        "position over time from q = 0.4 m, q' = 0.4 m/s at the start of the lift, time-stepping with h ="
        " 1e-4 s beside event-driven with tolerance 1e-12, at 358, 660 and 700 rpm."
    ),
    "3.5": ("the same motions in the plane of relative position and velocity."),
    "3.6": (
        "the chaotic attractor at 660 rpm on the impact map, phases from the corner b on, and on the "
        "stroboscopic map, by both methods."
    ),
    "4.3": (
        "follower and cam over time below the second detachment: two chattering sequences a turn, each "
        "ending with the follower at rest on the cam."
    ),
    "4.4": ("follower and cam over time above it: one chattering sequence a turn."),
    "4.5": (
        "(a) phases of the impacts, (b) position on the stroboscopic section, (c) accumulation points and"
        " number of impacts, 114 to 200 rpm, from rest on the cam, 60 periods kept. Detachment from "
        "114.979 rpm on; bubbles at 120.7356, 121.107, 121.686, 122.699 and 124.998 rpm; accumulation "
        "points on corners at 119.72 and 136.38 rpm; the detachment point at the end of the nose at "
        "134.873 rpm."
    ),
    "114-850": ("impacts and stroboscopic positions over the whole range of speeds."),
    "4.7": (
        "(a) impacts, (b) accumulation points and number of impacts where chattering of period one ends, "
        "near 198 rpm."
    ),
    "357.5-361.5": ("impacts and stroboscopic positions of the attractors that coexist there."),
    "4.10": (
        "the coexisting orbits O(3, 8) and O(1, 2) at 358.5 rpm, over time with the cam and in the state "
        "plane."
    ),
    "4.11": (
        "basins of both orbits at 358.5 rpm over absolute position 0.1 to 1.6 m and velocity -60 to 60 "
        "m/s, 1000 x 1000 cells."
    ),
    "4.12": (
        "impacts and stroboscopic positions, 660 to 760 rpm: O(1, 1), its flip near 739 rpm, chaos; "
        "739.378 and 740.2 rpm are named."
    ),
    "4.13": (
        "multipliers of O(1, 1) as a path in the complex plane with the unit circle, up to the flip at -1."
    ),
    "5.1": (
        "the transition at 673.234445 rpm: (a) impacts, (b) stroboscopic positions, (c, d) the orbit over"
        " its period and in the state plane."
    ),
    "5.4": (
        "diagrams of the local map and of the full system at the corner impact: for falling speed the "
        "stable orbit, of multipliers 0.6857 +- 0.4120 i, meets an unstable one, of 1.0052 and 0.6367, "
        "and both vanish."
    ),
    "6": ("scenarios of border collisions, as schemes."),
    "7.2": ("friction over slip on four roads."),
    "7.4": ("phase portraits in the plane of slip and torque of single states of the controller."),
    "7.5": ("phase portraits of the others."),
    "7-overview": (
        "the limit cycle in the plane and over time (its numbers 0.147, 0.419 and 0.517 s), its "
        "bifurcation over the torque threshold, and basins for each starting state."
    ),
    "7.15": (
        "the amplitude of the cycle over the torque threshold, and the equilibria on the isocline below "
        "its maximum."
    ),
}
