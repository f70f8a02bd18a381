"""The kernels of flights as plain Python: the same motions as built, to the last bit."""

import pytest

from tests.marks import slow
from tests.uncompiled import both_ways

PROGRAM = """
from hashlib import sha256
from numpy import ascontiguousarray, linspace
from lagrangian import scenes
from lcpstep import EventDriven, simulate
scene = {scene}
found = []
for keep in (1, "impacts", linspace(*scene.t_span, 7)):
    run = simulate(scene, EventDriven(), keep=keep)
    found += [run.t, run.q, run.v, run.impulse, run.impacts.time, run.impacts.after, run.impacts.kind]
found += run.at(run.t)
print(len(run.impacts), sha256(b"".join(ascontiguousarray(x).tobytes() for x in found)).hexdigest())
"""
SCENES = {
    "chattering to rest": ('scenes.CATALOGUE["bouncing-ball"].make(restitution=0.5)', 20),
    "a cam with corners": ("scenes.cam_follower(rpm=137.0, t_end=0.9)", 30),
    "absolute, damped": ('scenes.cam_follower(rpm=200.0, b=2.0, coordinates="absolute", t_end=0.3)', 5),
    "forced": ('scenes.CATALOGUE["sticking-oscillator"].make(t_end=8.0)', 5),
}


@pytest.mark.parametrize("scene", slow(SCENES, "chattering to rest", "absolute, damped", "forced"))
def test_flights_are_the_same_uncompiled(scene):
    expression, least = SCENES[scene]
    built, plain = both_ways(PROGRAM.replace("{scene}", expression))
    assert int(built[0].split()[0]) >= least
    assert built == plain


ARCS = {
    "an even belt, two coefficients": "scenes.stick_slip_belt(t_end=20.0)",
    "a belt that sways": "scenes.stick_slip_belt(amplitude=0.5, t_end=20.0)",
    "reversals": "scenes.coulomb_oscillator()",
}


@pytest.mark.parametrize("scene", slow(ARCS, "an even belt, two coefficients", "a belt that sways"))
def test_arcs_are_the_same_uncompiled(scene):
    built, plain = both_ways(PROGRAM.replace("{scene}", ARCS[scene]))
    assert int(built[0].split()[0]) >= 4
    assert built == plain
