"""Scenes ready to use, each a function of its parameters, and their catalogue by name."""

from __future__ import annotations

from lagrangian.scenes.beads import (
    column,
    elastic_gas,
    falling_gas,
    galperin,
    inelastic_collapse,
    newtons_cradle,
)
from lagrangian.scenes.belts import mass_on_belt, mass_on_shaken_belt, stick_slip_belt
from lagrangian.scenes.bouncing_ball import bouncing_ball, dyadic_ball, elastic_ball
from lagrangian.scenes.bowl import bowl
from lagrangian.scenes.cam_follower import cam_follower
from lagrangian.scenes.catalogue import Entry
from lagrangian.scenes.chain import elastic_chain
from lagrangian.scenes.double_pendulum import double_pendulum
from lagrangian.scenes.dry_friction import coulomb_oscillator, sliding_block, slipping_wheel, slope_landing
from lagrangian.scenes.grazing import grazing
from lagrangian.scenes.hinged_chain import hinged_chain
from lagrangian.scenes.hybrid_abs import hybrid_abs
from lagrangian.scenes.hybrid_oscillators import (
    bilinear_oscillator,
    driven_bilinear_oscillator,
    dry_friction_oscillator,
    stick_slip_oscillator,
)
from lagrangian.scenes.impact_oscillator import chaotic_oscillator, impact_oscillator, sticking_oscillator
from lagrangian.scenes.kane_pendulum import kane_pendulum
from lagrangian.scenes.pendulum import pendulum_stop
from lagrangian.scenes.piles import block_on_feet, heavy_on_light, stack
from lagrangian.scenes.rocking_block import rocking_block, sliding_rocking_block
from lagrangian.scenes.rough_contacts import falling_rod, woodpecker
from lagrangian.scenes.slider_crank import slider_crank
from lagrangian.scenes.superball import superball
from lagrangian.scenes.table import ball_on_table, chattering_table, jumping_table

CATALOGUE: dict[str, Entry] = {
    "bouncing-ball": Entry(
        bouncing_ball,
        hazard="an event-driven run stalls at the accumulation of impacts, or the ball tunnels through the floor",
        answer="parabolas of geometrically falling duration; at rest from sqrt(2 h0/g) (1 + r)/(1 - r) on",
    ),
    "dyadic-ball": Entry(
        dyadic_ball,
        hazard="impacts on the grid are counted twice, missed at the end of a step, or off by one step",
        answer="impacts at 1, 2, 2.5, 2.75, ... -> 3, exact in binary arithmetic",
    ),
    "elastic-ball": Entry(
        elastic_ball,
        hazard="energy and phase drift over many bounces",
        answer="period 2 v_1/g, constant energy",
    ),
    "ball-on-table": Entry(
        ball_on_table,
        hazard="the velocity of the table is taken at the wrong time, and the fixed point is off by O(h)",
        answer="cos(phase) = pi g (1 - r)/(A omega^2 (1 + r)); multipliers with product r^2",
    ),
    "chattering-table": Entry(
        chattering_table,
        hazard="released late or early, small bounces for ever, a release inside a step missed",
        answer="release at sin(phase) = g/(A omega^2), whatever came before",
    ),
    "jumping-table": Entry(
        jumping_table,
        hazard="the result depends on where in a step the velocity of the table jumps",
        answer="pieces in closed form; u- with the velocity before the jump, u+ with the new one",
    ),
    "impact-oscillator": Entry(
        impact_oscillator,
        hazard="time-stepping is of order one however smooth the motion in between",
        answer="pieces in closed form between impacts; 32 impacts in 100 s",
    ),
    "sticking-oscillator": Entry(
        sticking_oscillator,
        hazard="irregular convergence; stuck to the stop for ever",
        answer="pieces in closed form; release where amplitude cos(omega t) = stop",
    ),
    "chaotic-oscillator": Entry(
        chaotic_oscillator,
        hazard="trajectories are compared; time-stepping shifts the statistics",
        answer="statistics within their standard errors; largest Lyapunov exponent",
    ),
    "grazing": Entry(
        grazing,
        hazard="the minimum of the gap lies inside a step and is missed; half of the digits are lost",
        answer="touched with the speed sqrt(2 a d)",
    ),
    "pendulum-stop": Entry(
        pendulum_stop,
        hazard="the joint drifts; joint and contact impulses are not solved for together",
        answer="elliptic functions of modulus r^j sin(theta0/2); tension m (L theta'^2 + g cos theta)",
    ),
    "double-pendulum": Entry(
        double_pendulum,
        hazard="mass matrix taken at the wrong point: the order is lost",
        answer="states in 40 digits by Taylor series",
    ),
    "bowl": Entry(
        bowl,
        hazard="penetration drifts as the point slides; the normal taken at the start of a step costs four digits",
        answer="free fall, then a pendulum: elliptic functions",
    ),
    "elastic-gas": Entry(
        elastic_gas,
        hazard="one simultaneous problem in the place of a sequence of impacts",
        answer="free flights between the walls, sorted",
    ),
    "falling-gas": Entry(
        falling_gas,
        hazard="one simultaneous problem in the place of a sequence of impacts",
        answer="independent bouncing balls, sorted",
    ),
    "galperin": Entry(
        galperin,
        hazard="nearly equal velocities: the next event lies in the last bits",
        answer="3, 31, 314, 3141, ... collisions for k = 0, 1, 2, 3, ...; a straight line between two mirrors",
    ),
    "newtons-cradle": Entry(
        newtons_cradle,
        hazard="the law for simultaneous impacts is not said, or the energy grows",
        answer="touching: (1 - 2 r, 1 + r, 1 + r)/3; apart and r = 1: (0, 0, 1)",
    ),
    "inelastic-collapse": Entry(
        inelastic_collapse,
        hazard="endless loop at the accumulation of impacts, or a cluster with the wrong momentum",
        answer="the sequence of impacts in closed form; collapse iff r <= 7 - 4 sqrt(3), then one body",
    ),
    "column": Entry(
        column,
        hazard="sinking, explosion, endless iterations; using r min(u, 0) raises the energy of a pile",
        answer="all at rest and touching; each contact carries the weight above it",
    ),
    "block-on-feet": Entry(
        block_on_feet,
        hazard="the Delassus matrix is singular: pivots fail, forces drift, the block trembles",
        answer="nothing moves; forces and moments balance",
    ),
    "stack": Entry(
        stack,
        hazard="the Delassus matrix is singular: pivots fail, forces drift, the stack trembles",
        answer="nothing moves; the feet of each block carry all above",
    ),
    "heavy-on-light": Entry(
        heavy_on_light,
        hazard="sweeping methods need 14 R sweeps, direct ones lose log10 R digits of the forces",
        answer="forces g R and g (R + 1)",
    ),
    "elastic-chain": Entry(
        elastic_chain,
        hazard="the contact force oscillates; implicit steps lose the energy; the highest mode limits the step",
        answer="modes between contact and release, which is where the force vanishes",
    ),
    "rocking-block": Entry(
        rocking_block,
        hazard="both corners at once kill the rocking; the energy grows; impacts accumulate",
        answer="elliptic integrals; each impact leaves 1 - 3/2 sin^2(alpha) of the rate; stops in finite time",
    ),
    "coulomb-oscillator": Entry(
        coulomb_oscillator,
        hazard="creeping, or a sign that flips for ever",
        answer="half cycles of amplitude falling by 2 mu N/k; stops within the dead zone at a known place",
    ),
    "mass-on-belt": Entry(
        mass_on_belt,
        hazard="carried along, the mass trembles about the velocity of the belt, or is let go at the wrong place",
        answer="even belt: arcs of circles, carried to x = mu, then a circle that just touches the belt's velocity",
    ),
    "mass-on-shaken-belt": Entry(
        mass_on_shaken_belt,
        hazard="turns of the sliding fall inside a step",
        answer="Den Hartog's motion without a stop, and its multipliers, in closed form",
    ),
    "stick-slip-belt": Entry(
        stick_slip_belt,
        hazard="let go late or caught early: with two coefficients the force jumps as the mass begins to slip",
        answer="period 2 a/belt + pi + 2 atan(belt/a), a = mu_s - mu; dead-beat, for it slips at one place",
    ),
    "superball": Entry(
        superball,
        hazard="the tangent has no restitution, or friction acts with the force of a step and not as an impulse",
        answer="one bounce undoes the other: velocity and spin in closed form; energy constant",
    ),
    "sliding-rocking-block": Entry(
        sliding_rocking_block,
        hazard="sticking, sliding and impacts of two corners, of which none may be missed",
        answer="two equations while a corner slides; momentum against friction and weight",
    ),
    "slipping-wheel": Entry(
        slipping_wheel,
        hazard="the change from slipping to rolling falls inside a step",
        answer="slips until u0/(mu g (1 + m R^2/I)), then rolls",
    ),
    "sliding-block": Entry(
        sliding_block,
        hazard="the block is dragged backwards, or creeps",
        answer="stops at v0/(mu g) after v0^2/(2 mu g)",
    ),
    "slope-landing": Entry(
        slope_landing,
        hazard="the friction impulse is forgotten at the impact",
        answer="sticks iff |v_T| <= mu |v_N|; slides with g (sin a - mu cos a) otherwise",
    ),
    "kane-pendulum": Entry(
        kane_pendulum,
        hazard="Newton's law on the normal with Coulomb's on the tangent creates energy, silently",
        answer="Newton and Coulomb: +58.75 % energy; Moreau's law: -43.76 %",
    ),
    "woodpecker": Entry(
        woodpecker,
        hazard="an impact, a phase of sticking or its end is missed, and the toy jams or falls",
        answer="a periodic orbit of about 0.146 s that attracts; two methods agree on it",
    ),
    "falling-rod": Entry(
        falling_rod,
        hazard="from a coefficient of friction on there is no contact force, or two, and one is made up",
        answer="critical coefficient (1 + 3 cos^2)/(3 sin cos) of the angle, 4/3 at least; named beyond it",
    ),
    "slider-crank": Entry(
        slider_crank,
        hazard="many nearly simultaneous impacts of the corners",
        answer="constant energy of the free mechanism; self-convergence",
    ),
    "cam-follower": Entry(
        cam_follower,
        hazard="chattering, sticking, and release at a corner of the cam",
        answer="detachment where c'' = -(k/m) c: at 114.979 rpm (start of the nose) and 134.873 rpm (its end)",
    ),
}

WITH_MODES: dict[str, Entry] = {  # systems with modes: no contacts, so not for time-stepping
    "bilinear-oscillator": Entry(
        bilinear_oscillator,
        hazard="the change of stiffness falls inside a step, and the order is lost",
        answer="half waves of two sines; free period pi/sqrt(left) + pi/sqrt(right)",
    ),
    "driven-bilinear-oscillator": Entry(
        driven_bilinear_oscillator,
        hazard="the derivative of a period leaves out how the time of a switch moves",
        answer="orbits by matching two driven harmonic motions at x = 0; multipliers with product exp(-c T)",
    ),
    "dry-friction-oscillator": Entry(
        dry_friction_oscillator,
        hazard="the sign of the friction flips at every step where the motion sticks",
        answer="free: amplitude falls by 2 drag each half cycle; one multiplier is zero where it sticks",
    ),
    "stick-slip-oscillator": Entry(
        stick_slip_oscillator,
        hazard="release and capture fall inside a step; rounding leaves the block creeping on the belt",
        answer="period 2 a/belt + pi + 2 atan(belt/a), a = static - kinetic; one multiplier is zero",
    ),
    "hybrid-abs": Entry(
        hybrid_abs,
        hazard="a switch of the controller is missed, or the wheel locks between two steps",
        answer="a dead-beat cycle through (slip_max, torque_max): multiplier zero",
    ),
}
LARGE: dict[str, Entry] = {  # of as many bodies as asked for, described by sparse matrices: for time-stepping
    "hinged-chain": Entry(
        hinged_chain,
        hazard="dense matrices; lying flat, rods and sticking hinges say the same thing twice",
        answer="momentum while it falls; flat and at exact rest in the end; each step as by dense matrices",
    ),
}
SCENES: dict[str, Entry] = CATALOGUE | WITH_MODES | LARGE  # all, by name

__all__ = [
    "CATALOGUE", "LARGE", "SCENES", "WITH_MODES", "Entry", "ball_on_table", "bilinear_oscillator", "block_on_feet",
    "bouncing_ball", "bowl", "cam_follower", "chaotic_oscillator", "chattering_table", "column",
    "coulomb_oscillator", "double_pendulum", "driven_bilinear_oscillator", "dry_friction_oscillator", "dyadic_ball",
    "elastic_ball", "elastic_chain", "elastic_gas", "falling_gas", "falling_rod", "galperin", "grazing",
    "heavy_on_light", "hinged_chain", "hybrid_abs", "impact_oscillator", "inelastic_collapse", "jumping_table",
    "kane_pendulum", "mass_on_belt", "mass_on_shaken_belt", "newtons_cradle", "pendulum_stop", "rocking_block",
    "slider_crank", "sliding_block", "sliding_rocking_block", "slipping_wheel", "slope_landing", "stack",
    "stick_slip_belt", "stick_slip_oscillator", "sticking_oscillator", "superball", "woodpecker",
]  # fmt: skip
